// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/padded_grid.hpp"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace handeye {
namespace {

constexpr int kMargin = 15;

class PaddedGridOf : public testing::TestWithParam<int> {};

// OpenCV's erosion and dilation of an image whose border goes on are the reference.
TEST_P(PaddedGridOf, OpensAsOpenCvDoes) {
  const int side = GetParam();
  cv::Mat1b image(37, 53);
  cv::RNG random(3);
  random.fill(image, cv::RNG::UNIFORM, 0, 256);
  PaddedGrid grid;
  grid.resize(image.cols, image.rows, kMargin);
  for (int y = 0; y < image.rows; ++y) std::copy_n(image[y], image.cols, grid.row(y));
  grid.fill_margin();
  grid.smallest_ahead(side);
  grid.largest_ahead(side);

  cv::Mat1b wide;
  cv::copyMakeBorder(image, wide, kMargin, kMargin, kMargin, kMargin, cv::BORDER_REPLICATE);
  const cv::Mat square = cv::Mat::ones(side, side, CV_8UC1);
  const cv::Point first(0, 0);
  const cv::Point last(side - 1, side - 1);
  cv::erode(wide, wide, square, first, 1, cv::BORDER_REPLICATE);
  cv::dilate(wide, wide, square, last, 1, cv::BORDER_REPLICATE);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      ASSERT_EQ(grid.row(y - side + 1)[x - side + 1], wide(y + kMargin, x + kMargin))
          << "at " << x << ", " << y;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Squares, PaddedGridOf, testing::Values(1, 2, 3, 5, 8, 15));

}  // namespace
}  // namespace handeye
