// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace handeye::test {

/// What the tracker is measured against: OpenCV's pyramidal Lucas-Kanade from frame to frame
/// (21x21, three levels beyond the image, 30 iterations, 0.01), and back to within half a pixel.
class OpenCvFlow {
 public:
  OpenCvFlow(const cv::Mat& first, const std::vector<Eigen::Vector2d>& corners);

  void track(const cv::Mat& grey);

  bool alive(std::size_t corner) const { return alive_[corner] != 0; }
  Eigen::Vector2d pixel(std::size_t corner) const { return {pixels_[corner].x, pixels_[corner].y}; }

 private:
  std::vector<cv::Mat> last_, now_;  ///< pyramids
  std::vector<cv::Point2f> pixels_;
  std::vector<std::uint8_t> alive_;
};

}  // namespace handeye::test
