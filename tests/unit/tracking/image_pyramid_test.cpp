// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/image_pyramid.hpp"

#include <gtest/gtest.h>

namespace handeye {
namespace {

constexpr int kLevels = 3;

/// What a picture becomes, with one pixel changed and without: where they differ the pixel had a
/// say.
class PyramidOfASpot : public testing::TestWithParam<int> {};

TEST_P(PyramidOfASpot, LooksAtNothingThatAMaskedPixelHasASayIn) {
  const int halvings = GetParam();
  const cv::Size size(160, 120);
  for (const cv::Point spot : {cv::Point(80, 60), cv::Point(81, 60), cv::Point(82, 63),
                               cv::Point(83, 61), cv::Point(0, 119), cv::Point(159, 3)}) {
    const cv::Mat plain(size, CV_8UC1, cv::Scalar(20));
    cv::Mat spotted = plain.clone();
    spotted.at<std::uint8_t>(spot) = 255;
    cv::Mat mask(size, CV_8UC1, cv::Scalar(255));
    mask.at<std::uint8_t>(spot) = 0;
    ImagePyramid without;
    ImagePyramid with;
    without.build(plain, {}, halvings, kLevels);
    with.build(spotted, mask, halvings, kLevels);
    for (int level = 0; level < kLevels; ++level) {
      const cv::Size of_level = with.grey(level).size();
      int hidden = 0;
      for (int y = 0; y < of_level.height; ++y) {
        for (int x = 0; x < of_level.width; ++x) {
          const bool usable = *with.usable(level).at(x, y) != 0;
          hidden += usable ? 0 : 1;
          if (!usable) continue;
          ASSERT_EQ(*with.grey(level).at(x, y), *without.grey(level).at(x, y))
              << spot << " seen at " << x << ", " << y << " of level " << level;
        }
      }
      EXPECT_GT(hidden, 0);
      EXPECT_LE(hidden, 16);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Halvings, PyramidOfASpot, testing::Values(0, 1, 2));

TEST(ImagePyramid, ForgetsAMaskThatIsGoneAndKnowsItWhenItReturns) {
  const cv::Mat grey(120, 160, CV_8UC1, cv::Scalar(90));
  cv::Mat mask(120, 160, CV_8UC1, cv::Scalar(255));
  mask.colRange(0, 80) = 0;
  ImagePyramid pyramid;
  for (int round = 0; round < 2; ++round) {
    pyramid.build(grey, mask, 0, kLevels);
    EXPECT_FALSE(pyramid.all_usable(0, 60, 60, 70, 70));
    EXPECT_TRUE(pyramid.all_usable(0, 90, 60, 99, 70));
    EXPECT_NEAR(pyramid.usable_share(), 0.5, 0.02);
    pyramid.build(grey, {}, 0, kLevels);
    EXPECT_TRUE(pyramid.all_usable(0, 60, 60, 70, 70));
    EXPECT_EQ(pyramid.usable_share(), 1.0);
  }
}

}  // namespace
}  // namespace handeye
