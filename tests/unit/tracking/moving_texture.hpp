// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace handeye::test {

/// A flat picture that turns, grows and slides under the camera, with every position known.
class MovingTexture {
 public:
  explicit MovingTexture(cv::Size image_size, unsigned seed = 1);

  /// The image at a frame. `light`: 0 even light; above, a bright spot that stays in the middle of
  /// the image while the picture moves, as an endoscope's does.
  cv::Mat image(int frame, double light = 0.0) const;

  /// Where a point that was seen at `pixel` in frame `from` is in frame `to`.
  Eigen::Vector2d moved(const Eigen::Vector2d& pixel, int from, int to) const;

 private:
  cv::Matx33d image_from_texture(int frame) const;

  cv::Size size_;
  cv::Mat texture_;
};

}  // namespace handeye::test
