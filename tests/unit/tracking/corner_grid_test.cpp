// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/corner_grid.hpp"

#include <cmath>

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

ImagePyramid pyramid_of(const cv::Mat& image, const cv::Mat& usable = {}) {
  ImagePyramid pyramid;
  pyramid.build(image, usable, 0, 2);
  return pyramid;
}

Eigen::Vector2f pixel_of(const Corner& corner) {
  return {static_cast<float>(corner.x), static_cast<float>(corner.y)};
}

TEST(CornerGrid, FindsACornerInEveryCellThatHasOne) {
  CornerGrid grid({320, 240}, 48, 8);
  std::vector<Corner> corners;
  grid.detect(pyramid_of(squares()), {}, grid.cell_count(), corners);
  EXPECT_GE(corners.size(), 40U);
  for (const Corner& corner : corners) {
    // Corners of the squares lie at 20 or 31 (mod 40); the window that shows one best is near.
    for (const double along : {corner.x, corner.y}) {
      const double within = std::fmod(along, 40.0);
      EXPECT_LT(std::min(std::abs(within - 20.0), std::abs(within - 31.0)), 6.0);
    }
  }
}

TEST(CornerGrid, LeavesOccupiedCellsAlone) {
  CornerGrid grid({320, 240}, 48, 8);
  std::vector<Corner> corners;
  const ImagePyramid pyramid = pyramid_of(squares());
  grid.detect(pyramid, {}, grid.cell_count(), corners);
  std::vector<Eigen::Vector2f> features;
  for (const Corner& corner : corners) features.push_back(pixel_of(corner));
  grid.detect(pyramid, features, grid.cell_count(), corners);
  EXPECT_TRUE(corners.empty());
}

TEST(CornerGrid, LooksAtFewCellsAtATimeButAtAllInTurn) {
  CornerGrid grid({320, 240}, 48, 8);
  const ImagePyramid pyramid = pyramid_of(squares());
  std::vector<Corner> corners;
  std::vector<Eigen::Vector2f> features;
  for (int call = 0; call < 5; ++call) {
    grid.detect(pyramid, features, 10, corners);
    EXPECT_LE(corners.size(), 10U);
    for (const Corner& corner : corners) features.push_back(pixel_of(corner));
  }
  EXPECT_GE(features.size(), 40U);
}

TEST(CornerGrid, KeepsAwayFromHighlightsAndFlatImages) {
  CornerGrid grid({320, 240}, 48, 8);
  cv::Mat image(240, 320, CV_8UC1, cv::Scalar(100));
  std::vector<Corner> corners;
  grid.detect(pyramid_of(image), {}, grid.cell_count(), corners);
  EXPECT_TRUE(corners.empty());
  cv::circle(image, {160, 120}, 9, 255, cv::FILLED);
  grid.detect(pyramid_of(image), {}, grid.cell_count(), corners);
  EXPECT_TRUE(corners.empty());
}

TEST(CornerGrid, KeepsTheWholePatchInTheUsableArea) {
  CornerGrid grid({320, 240}, 48, 8);
  cv::Mat usable = cv::Mat::zeros(240, 320, CV_8UC1);
  usable(cv::Rect(0, 0, 160, 240)) = 255;
  std::vector<Corner> corners;
  grid.detect(pyramid_of(squares(), usable), {}, grid.cell_count(), corners);
  EXPECT_GE(corners.size(), 15U);
  for (const Corner& corner : corners) EXPECT_LT(corner.x, 150);
}

}  // namespace
}  // namespace handeye
