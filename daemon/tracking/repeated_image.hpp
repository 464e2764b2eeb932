// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

namespace handeye {

/// Tells the same picture again from a new one: a grabber that has lost its signal, or a video
/// processor that was told to freeze, goes on sending its last picture with new time stamps.
///
/// A live picture differs from the one before by its sensor's noise even where nothing moves; a
/// repeated one is the same bit for bit, or but for the rounding of being coded once more and a
/// clock shown in a corner. Each image is compared with the last that was not a repetition, so that
/// a slow movement cannot hide: what is taken for one for want of noise is the picture that was
/// used already, and nothing is lost with it.
class RepeatedImage {
 public:
  /// Looks at the next image (CV_8UC1); some rows of it are read. True: a repetition.
  bool is_repetition(const cv::Mat& grey);

 private:
  void remember(const cv::Mat& grey);

  cv::Size size_;
  std::vector<std::uint8_t> rows_;  ///< those looked at, of the last image that was new
};

}  // namespace handeye
