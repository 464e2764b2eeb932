// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

namespace handeye {

/// The means of square blocks, about 160 in a row, of bands across an image: enough to judge it as
/// a whole, at a fraction of the cost of shrinking it. Blocks average the noise away.
class BlockMeans {
 public:
  /// Of a CV_8UC1 image; memory is kept.
  void take(const cv::Mat& grey);

  /// Grey levels. Rows 2 k and 2 k + 1 are neighbours in the image, pairs lie apart.
  const cv::Mat1b& means() const { return means_; }

 private:
  void take_row(const cv::Mat& grey, int top, int side, std::uint8_t* means);

  cv::Mat1b means_;
  std::vector<std::uint16_t> column_sums_;
};

}  // namespace handeye
