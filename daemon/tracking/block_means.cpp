// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/block_means.hpp"

#include <algorithm>

namespace handeye {
namespace {

constexpr int kColumns = 160;  ///< or a few more
constexpr int kPairs = 16;     ///< of rows of blocks

}  // namespace

void BlockMeans::take(const cv::Mat& grey) {
  const int side = std::max(1, grey.cols / kColumns);
  const int pairs = std::clamp(grey.rows / (2 * side), 0, kPairs);
  means_.create(2 * pairs, grey.cols / side);
  column_sums_.resize(static_cast<std::size_t>(grey.cols));
  for (int pair = 0; pair < pairs; ++pair) {
    // In the middles of equal shares of the image.
    const int top = (2 * pair + 1) * grey.rows / (2 * pairs) - side;
    take_row(grey, top, side, means_[2 * pair]);
    take_row(grey, top + side, side, means_[2 * pair + 1]);
  }
}

void BlockMeans::take_row(const cv::Mat& grey, int top, int side, std::uint8_t* means) {
  std::ranges::fill(column_sums_, std::uint16_t{0});
  std::uint16_t* sums = column_sums_.data();
  for (int y = top; y < top + side; ++y) {
    const auto* row = grey.ptr<std::uint8_t>(y);
    for (int x = 0; x < grey.cols; ++x) sums[x] = static_cast<std::uint16_t>(sums[x] + row[x]);
  }
  const int area = side * side;
  for (int block = 0; block < means_.cols; ++block) {
    int sum = 0;
    for (int x = block * side; x < (block + 1) * side; ++x) sum += sums[x];
    means[block] = static_cast<std::uint8_t>((sum + area / 2) / area);
  }
}

}  // namespace handeye
