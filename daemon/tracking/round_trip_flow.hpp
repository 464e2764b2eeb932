// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

namespace handeye {

/// OpenCV's pyramidal Lucas-Kanade (Bouguet 2001) from one image to another and back: a feature
/// that does not come home was not found. Holds its scratch memory, so that a frame allocates
/// nothing.
class RoundTripFlow {
 public:
  void set_window(int side_px) { window_ = {side_px, side_px}; }
  cv::Size window() const { return window_; }

  /// Where features of `from` are in `to` (pyramids of cv::buildOpticalFlowPyramid with this
  /// window). `found_pixels` holds the starting positions and receives the result; `good[i]` is 0
  /// where the feature was not found or missed its origin by more than `max_miss_px`.
  void run(const std::vector<cv::Mat>& from, const std::vector<cv::Mat>& to, int levels,
           double max_miss_px, const std::vector<cv::Point2f>& pixels,
           std::vector<cv::Point2f>& found_pixels, std::vector<std::uint8_t>& good);

 private:
  cv::Size window_{21, 21};
  std::vector<cv::Point2f> back_;
  std::vector<std::uint8_t> found_back_;
  std::vector<float> errors_;
};

}  // namespace handeye
