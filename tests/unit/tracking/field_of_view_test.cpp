// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/field_of_view.hpp"

#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace handeye {
namespace {

std::filesystem::path data_folder() {
  const char* configured = std::getenv("HANDEYE_DATA");
  if (configured != nullptr) return configured;
  return std::filesystem::path(HANDEYE_SOURCE_DIR) / "../shared/data";
}

struct Agreement {
  double overlap{0};  ///< intersection over union
  int outside{0};     ///< px found that are not of the truth
};

Agreement compare(const cv::Mat& found, const cv::Mat& truth) {
  const double common = cv::countNonZero(found & truth);
  return {common / cv::countNonZero(found | truth), cv::countNonZero(found & ~truth)};
}

/// Tissue-like brightness, with a dark cavity.
cv::Mat scene(cv::Size size) {
  cv::Mat image(size, CV_8UC1);
  cv::RNG random(5);
  random.fill(image, cv::RNG::UNIFORM, 60, 255);
  cv::GaussianBlur(image, image, {}, 0.02 * size.width);
  cv::normalize(image, image, 50, 210, cv::NORM_MINMAX);
  cv::circle(image, {size.width / 2, size.height / 3}, size.height / 10, 15, cv::FILLED);
  return image;
}

struct Disc {
  cv::Size size;
  cv::Point centre;
  int radius;
};

class EndoscopeDisc : public testing::TestWithParam<Disc> {};

TEST_P(EndoscopeDisc, IsFoundFromWithin) {
  const Disc disc = GetParam();
  cv::Mat truth = cv::Mat::zeros(disc.size, CV_8UC1);
  cv::circle(truth, disc.centre, disc.radius, 255, cv::FILLED);
  cv::Mat image(disc.size, CV_8UC1);
  cv::RNG random(9);
  random.fill(image, cv::RNG::NORMAL, 4, 2);  // what a sensor shows of nothing
  scene(disc.size).copyTo(image, truth);
  const cv::Mat found = find_field_of_view(image);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.size(), disc.size);
  EXPECT_EQ(found.type(), CV_8UC1);
  EXPECT_EQ(cv::countNonZero((found != 0) & (found != 255)), 0);
  const Agreement agreement = compare(found, truth);
  EXPECT_EQ(agreement.outside, 0);
  EXPECT_GT(agreement.overlap, 0.85);
}

INSTANTIATE_TEST_SUITE_P(Discs, EndoscopeDisc,
                         testing::Values(Disc{{640, 480}, {320, 240}, 200},  // whole
                                         Disc{{640, 480}, {320, 240}, 280},  // cut above and below
                                         Disc{{1920, 1080}, {900, 520}, 480},  // off the centre
                                         Disc{{1280, 720}, {640, 360}, 250}));

TEST(FieldOfView, IsTheWholeImageOfAnOrdinaryCamera) {
  EXPECT_TRUE(find_field_of_view(scene({640, 480})).empty());
}

TEST(FieldOfView, SaysNothingOfTheDark) {
  EXPECT_TRUE(find_field_of_view(cv::Mat::zeros(480, 640, CV_8UC1)).empty());
  cv::Mat noise(480, 640, CV_8UC1);
  cv::RNG random(2);
  random.fill(noise, cv::RNG::NORMAL, 12, 5);
  EXPECT_TRUE(find_field_of_view(noise).empty());
}

TEST(FieldOfView, IgnoresABrightSpotInADarkRoom) {
  cv::Mat image(480, 640, CV_8UC1, cv::Scalar(5));
  cv::circle(image, {200, 200}, 40, 220, cv::FILLED);
  EXPECT_TRUE(find_field_of_view(image).empty());
}

TEST(FieldOfView, OfARealEndoscopeLiesWithinItsMask) {
  const auto folder = data_folder() / "sinus";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there: set HANDEYE_DATA";
  const cv::Mat mask = cv::imread(folder / "mask.png", cv::IMREAD_GRAYSCALE);
  int frames = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "frames")) {
    const cv::Mat found = find_field_of_view(cv::imread(entry.path(), cv::IMREAD_GRAYSCALE));
    ASSERT_FALSE(found.empty()) << entry.path();
    const Agreement agreement = compare(found, mask);
    EXPECT_GT(agreement.overlap, 0.85) << entry.path();
    EXPECT_EQ(agreement.outside, 0) << entry.path();
    ++frames;
  }
  EXPECT_EQ(frames, 35);
}

TEST(FieldOfView, IsTheWholeImageOfRealPictures) {
  const auto folder = data_folder() / "chessboard" / "frames";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there: set HANDEYE_DATA";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    EXPECT_TRUE(find_field_of_view(cv::imread(entry.path(), cv::IMREAD_GRAYSCALE)).empty())
        << entry.path();
  }
}

}  // namespace
}  // namespace handeye
