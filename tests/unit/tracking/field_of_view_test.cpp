// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/field_of_view.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/unit/tracking/endoscope_disc.hpp"

namespace handeye {
namespace {

using test::Agreement;
using test::compare;
using test::Disc;
using test::expect_within;
using test::tissue;
using test::truth_of;
using test::view;

std::filesystem::path data_folder() {
  const char* configured = std::getenv("HANDEYE_DATA");
  if (configured != nullptr) return configured;
  return std::filesystem::path(HANDEYE_SOURCE_DIR) / "../shared/data";
}

/// What one image alone tells.
cv::Mat field_of_one(const cv::Mat& grey) {
  return FieldOfView().look(grey).clone();
}

class EndoscopeDisc : public testing::TestWithParam<Disc> {};

TEST_P(EndoscopeDisc, IsFoundFromWithin) {
  const cv::Mat truth = truth_of(GetParam());
  const cv::Mat found = field_of_one(view(GetParam()));
  ASSERT_EQ(found.type(), CV_8UC1);
  EXPECT_EQ(cv::countNonZero((found != 0) & (found != 255)), 0);
  expect_within(found, truth, 0.88);
}

INSTANTIATE_TEST_SUITE_P(Discs, EndoscopeDisc,
                         testing::Values(Disc{{640, 480}, {320, 240}, 200},  // whole
                                         Disc{{640, 480}, {320, 240}, 280},  // cut above and below
                                         Disc{{1920, 1080}, {900, 520}, 480},  // off the centre
                                         Disc{{1280, 720}, {640, 360}, 250},
                                         Disc{{720, 576}, {250, 300}, 230},    // cut on the left
                                         Disc{{640, 480}, {520, 200}, 160}));  // far off

const Disc kDisc{{640, 480}, {330, 235}, 205};

TEST(FieldOfView, ToleratesWordsBesideTheDisc) {
  cv::Mat image = view(kDisc);
  cv::putText(image, "NAME: N.N.", {8, 30}, cv::FONT_HERSHEY_SIMPLEX, 0.7, 235, 2);
  cv::putText(image, "22.11. 12:30", {500, 460}, cv::FONT_HERSHEY_SIMPLEX, 0.6, 235, 2);
  cv::putText(image, "ID 4711", {8, 60}, cv::FONT_HERSHEY_SIMPLEX, 0.7, 235, 2);
  expect_within(field_of_one(image), truth_of(kDisc), 0.88);
}

TEST(FieldOfView, ToleratesHighlightsAndCavitiesAtTheRim) {
  cv::Mat image = view(kDisc);
  const cv::Mat truth = truth_of(kDisc);
  cv::Mat at_rim = cv::Mat::zeros(kDisc.size, CV_8UC1);
  cv::circle(at_rim, kDisc.centre + cv::Point(195, 0), 30, 255, cv::FILLED);
  image.setTo(255, at_rim & truth);
  cv::Mat cavity = cv::Mat::zeros(kDisc.size, CV_8UC1);
  cv::circle(cavity, kDisc.centre + cv::Point(-180, 80), 70, 255, cv::FILLED);
  image.setTo(6, cavity & truth);
  const cv::Mat found = field_of_one(image);
  expect_within(found, truth, 0.75);
}

TEST(FieldOfView, LeavesBlackBarsOut) {
  const cv::Rect picture(160, 0, 960, 720);
  cv::Mat truth = cv::Mat::zeros(720, 1280, CV_8UC1);
  truth(picture) = 255;
  cv::Mat image(truth.size(), CV_8UC1, cv::Scalar(16));
  tissue(picture.size()).copyTo(image(picture));
  expect_within(field_of_one(image), truth, 0.88);
  // A disc within the bars.
  const Disc disc{{1280, 720}, {640, 360}, 330};
  expect_within(field_of_one(view(disc)), truth_of(disc), 0.88);
}

TEST(FieldOfView, IsTheWholeImageUnderAnyShading) {
  const cv::Size size(640, 480);
  for (const double corner : {0.5, 0.2, 0.1, 0.05, 0.02}) {
    cv::Mat image = tissue(size);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const double r2 = (std::pow(x - 320.0, 2) + std::pow(y - 240.0, 2)) / (400.0 * 400.0);
        auto& pixel = image.at<std::uint8_t>(y, x);
        pixel = cv::saturate_cast<std::uint8_t>(pixel * std::pow(corner, r2));
      }
    }
    EXPECT_TRUE(field_of_one(image).empty()) << "corners at " << corner;
  }
}

// Whatever fills the frame: nothing is cut away, however its light falls.
TEST(FieldOfView, IsTheWholeImageOfAnyScene) {
  const cv::Size size(640, 480);
  cv::RNG random(17);
  int cut = 0;
  for (int trial = 0; trial < 150; ++trial) {
    cv::Mat image(12, 16, CV_8UC1);
    random.fill(image, cv::RNG::UNIFORM, -150, 256);  // a good third of it black
    cv::resize(image, image, size, 0, 0, cv::INTER_CUBIC);
    image += 8;
    FieldOfView field;
    cut += !field.look(image).empty();
  }
  EXPECT_EQ(cut, 0);
}

TEST(FieldOfView, IsTheWholeImageOfAnOrdinaryCamera) {
  EXPECT_TRUE(field_of_one(tissue({640, 480})).empty());
}

TEST(FieldOfView, SaysNothingOfTheDark) {
  EXPECT_TRUE(field_of_one(cv::Mat::zeros(480, 640, CV_8UC1)).empty());
  cv::Mat noise(480, 640, CV_8UC1);
  cv::RNG random(2);
  random.fill(noise, cv::RNG::NORMAL, 12, 5);
  EXPECT_TRUE(field_of_one(noise).empty());
}

TEST(FieldOfView, IgnoresABrightSpotInADarkRoom) {
  cv::Mat image(480, 640, CV_8UC1, cv::Scalar(5));
  cv::circle(image, {200, 200}, 40, 220, cv::FILLED);
  EXPECT_TRUE(field_of_one(image).empty());
}

TEST(FieldOfView, OfARealEndoscopeLiesWithinItsMask) {
  const auto folder = data_folder() / "sinus";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there: set HANDEYE_DATA";
  const cv::Mat mask = cv::imread(folder / "mask.png", cv::IMREAD_GRAYSCALE);
  int frames = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "frames")) {
    const cv::Mat found = field_of_one(cv::imread(entry.path(), cv::IMREAD_GRAYSCALE));
    ASSERT_FALSE(found.empty()) << entry.path();
    const Agreement agreement = compare(found, mask);
    EXPECT_GT(agreement.overlap, 0.92) << entry.path();
    EXPECT_EQ(agreement.outside, 0) << entry.path();
    ++frames;
  }
  EXPECT_EQ(frames, 35);
}

TEST(FieldOfView, IsTheWholeImageOfRealPictures) {
  const auto folder = data_folder() / "chessboard" / "frames";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there: set HANDEYE_DATA";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    EXPECT_TRUE(field_of_one(cv::imread(entry.path(), cv::IMREAD_GRAYSCALE)).empty())
        << entry.path();
  }
}

}  // namespace
}  // namespace handeye
