// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/corner_grid.hpp"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace handeye {
namespace {

/// Dark squares on grey, 40 px apart.
cv::Mat squares() {
  cv::Mat image(240, 320, CV_8UC1, cv::Scalar(150));
  for (int y = 20; y < 240; y += 40) {
    for (int x = 20; x < 320; x += 40) {
      cv::rectangle(image, cv::Rect(x, y, 12, 12), cv::Scalar(60), cv::FILLED);
    }
  }
  return image;
}

TEST(CornerGrid, FindsACornerInEveryCellThatHasOne) {
  CornerGrid grid({320, 240}, 48, 8);
  std::vector<Corner> corners;
  const cv::Mat image = squares();
  grid.detect(image, image, {}, {}, grid.cell_count(), corners);
  EXPECT_GE(corners.size(), 40U);
  for (const Corner& corner : corners) {
    // Corners of the squares lie at 20 or 31 (mod 40).
    for (const double along : {corner.pixel.x, corner.pixel.y}) {
      const double within = std::fmod(along, 40.0);
      EXPECT_LT(std::min(std::abs(within - 20.0), std::abs(within - 31.0)), 4.0);
    }
  }
}

TEST(CornerGrid, LeavesOccupiedCellsAlone) {
  CornerGrid grid({320, 240}, 48, 8);
  std::vector<Corner> corners;
  const cv::Mat image = squares();
  grid.detect(image, image, {}, {}, grid.cell_count(), corners);
  std::vector<cv::Point2f> features;
  for (const Corner& corner : corners) features.push_back(corner.pixel);
  grid.detect(image, image, {}, features, grid.cell_count(), corners);
  EXPECT_TRUE(corners.empty());
}

TEST(CornerGrid, LooksAtFewCellsAtATimeButAtAllInTurn) {
  CornerGrid grid({320, 240}, 48, 8);
  const cv::Mat image = squares();
  std::vector<Corner> corners;
  std::vector<cv::Point2f> features;
  for (int call = 0; call < 5; ++call) {
    grid.detect(image, image, {}, features, 10, corners);
    EXPECT_LE(corners.size(), 10U);
    for (const Corner& corner : corners) features.push_back(corner.pixel);
  }
  EXPECT_GE(features.size(), 40U);
}

TEST(CornerGrid, KeepsAwayFromHighlightsAndFlatImages) {
  CornerGrid grid({320, 240}, 48, 8);
  cv::Mat image(240, 320, CV_8UC1, cv::Scalar(100));
  std::vector<Corner> corners;
  grid.detect(image, image, {}, {}, grid.cell_count(), corners);
  EXPECT_TRUE(corners.empty());
  cv::circle(image, {160, 120}, 9, 255, cv::FILLED);
  grid.detect(image, image, {}, {}, grid.cell_count(), corners);
  EXPECT_TRUE(corners.empty());
}

TEST(CornerGrid, StaysInTheUsableArea) {
  CornerGrid grid({320, 240}, 48, 8);
  const cv::Mat image = squares();
  cv::Mat usable = cv::Mat::zeros(image.size(), CV_8UC1);
  usable(cv::Rect(0, 0, 160, 240)) = 255;
  std::vector<Corner> corners;
  grid.detect(image, image, usable, {}, grid.cell_count(), corners);
  EXPECT_GE(corners.size(), 20U);
  for (const Corner& corner : corners) EXPECT_LT(corner.pixel.x, 160.0F);
}

}  // namespace
}  // namespace handeye
