// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace handeye::test {

/// Images whose every point can be followed by computation.
struct KnownMotion {
  int frames{0};
  cv::Size size;
  std::function<cv::Mat(int frame)> image;
  /// Where the point seen at `pixel` of frame 0 is in a later frame; nothing where it is hidden.
  std::function<std::optional<Eigen::Vector2d>(const Eigen::Vector2d& pixel, int frame)> truth;
};

/// What became of the corners of the first image.
struct TrackRecord {
  int corners{0};  ///< those that stay in the image to the last frame: the others do not count
  int kept{0};     ///< to the last frame
  double median_px{0}, rms_px{0};  ///< distance from the truth, over all frames of a feature's life
};

struct Comparison {
  TrackRecord ours, opencv;
};

/// Tracks with both, from the corners that ours finds in the first image.
Comparison compare_with_opencv(const KnownMotion& motion);

}  // namespace handeye::test
