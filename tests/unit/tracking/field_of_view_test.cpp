// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/field_of_view.hpp"

#include <cmath>
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

cv::Mat truth_of(const Disc& disc) {
  cv::Mat truth = cv::Mat::zeros(disc.size, CV_8UC1);
  cv::circle(truth, disc.centre, disc.radius, 255, cv::FILLED);
  return truth;
}

/// What an endoscope of this disc shows.
cv::Mat view(const Disc& disc, unsigned seed = 9) {
  cv::Mat image(disc.size, CV_8UC1);
  cv::RNG random(seed);  // what a sensor shows of nothing
  random.fill(image, cv::RNG::NORMAL, 4, 2);
  scene(disc.size).copyTo(image, truth_of(disc));
  return image;
}

void expect_within(const cv::Mat& found, const cv::Mat& truth, double overlap) {
  ASSERT_EQ(found.size(), truth.size());
  const Agreement agreement = compare(found, truth);
  EXPECT_EQ(agreement.outside, 0);
  EXPECT_GT(agreement.overlap, overlap);
}

class EndoscopeDisc : public testing::TestWithParam<Disc> {};

TEST_P(EndoscopeDisc, IsFoundFromWithin) {
  const cv::Mat truth = truth_of(GetParam());
  const cv::Mat found = find_field_of_view(view(GetParam()));
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
  expect_within(find_field_of_view(image), truth_of(kDisc), 0.88);
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
  const cv::Mat found = find_field_of_view(image);
  expect_within(found, truth, 0.75);
}

TEST(FieldOfView, FillsInAsTheSceneMoves) {
  // A cavity wanders along the rim; after a while every part of the disc was lit.
  const cv::Mat truth = truth_of(kDisc);
  FieldOfView field;
  for (int frame = 0; frame < 60; ++frame) {
    cv::Mat image = view(kDisc, static_cast<unsigned>(frame));
    cv::Mat cavity = cv::Mat::zeros(kDisc.size, CV_8UC1);
    const double angle = 0.2 * frame;
    cv::circle(
        cavity,
        kDisc.centre + cv::Point(cvRound(170 * std::cos(angle)), cvRound(170 * std::sin(angle))),
        80, 255, cv::FILLED);
    image.setTo(6, cavity & truth);
    field.look(image);
  }
  expect_within(field.mask(), truth, 0.88);
}

TEST(FieldOfView, OutlivesDarkImagesAndFlares) {
  const cv::Mat truth = truth_of(kDisc);
  FieldOfView field;
  EXPECT_TRUE(field.look(cv::Mat::zeros(kDisc.size, CV_8UC1)).empty());
  EXPECT_TRUE(field.look(view(kDisc) * 0.1).empty());
  cv::Mat flare = view(kDisc);
  flare += 90;  // beyond the rim too
  field.look(flare);
  for (int frame = 0; frame < 40; ++frame) field.look(view(kDisc, static_cast<unsigned>(frame)));
  expect_within(field.mask(), truth, 0.88);
  const cv::Mat before = field.mask().clone();
  for (int frame = 0; frame < 200; ++frame) {
    field.look(frame % 50 == 7 ? flare : cv::Mat::zeros(kDisc.size, CV_8UC1));
  }
  EXPECT_EQ(cv::norm(before, field.mask(), cv::NORM_INF), 0);
}

TEST(FieldOfView, StaysTheSameWhileTheSceneChanges) {
  FieldOfView field;
  field.look(view(kDisc));
  const auto* memory = field.mask().data;
  ASSERT_NE(memory, nullptr);
  for (int frame = 1; frame < 50; ++frame) {
    cv::Mat image = view(kDisc, static_cast<unsigned>(frame));
    image.setTo(6, (scene(kDisc.size) > 150 - frame % 40) & truth_of(kDisc));
    EXPECT_EQ(field.look(image).data, memory) << frame;
  }
}

TEST(FieldOfView, IsGivenUpWhereItWasNone) {
  // A bright plate on a black table, seen by an ordinary camera that then goes nearer.
  const cv::Size size(640, 480);
  FieldOfView field;
  EXPECT_FALSE(field.look(view({size, {320, 240}, 180})).empty());
  for (int frame = 0; frame < 60; ++frame) field.look(scene(size));
  EXPECT_TRUE(field.mask().empty());
}

TEST(FieldOfView, IsWhatWasGiven) {
  const cv::Mat given = truth_of({{640, 480}, {100, 100}, 50});
  FieldOfView field(given);
  EXPECT_EQ(field.look(view(kDisc)).data, given.data);
}

TEST(FieldOfView, LeavesBlackBarsOut) {
  const cv::Rect picture(160, 0, 960, 720);
  cv::Mat truth = cv::Mat::zeros(720, 1280, CV_8UC1);
  truth(picture) = 255;
  cv::Mat image(truth.size(), CV_8UC1, cv::Scalar(16));
  scene(picture.size()).copyTo(image(picture));
  expect_within(find_field_of_view(image), truth, 0.88);
  // A disc within the bars.
  const Disc disc{{1280, 720}, {640, 360}, 330};
  expect_within(find_field_of_view(view(disc)), truth_of(disc), 0.88);
}

TEST(FieldOfView, IsTheWholeImageUnderAnyShading) {
  const cv::Size size(640, 480);
  for (const double corner : {0.5, 0.2, 0.1, 0.05, 0.02}) {
    cv::Mat image = scene(size);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const double r2 = (std::pow(x - 320.0, 2) + std::pow(y - 240.0, 2)) / (400.0 * 400.0);
        auto& pixel = image.at<std::uint8_t>(y, x);
        pixel = cv::saturate_cast<std::uint8_t>(pixel * std::pow(corner, r2));
      }
    }
    EXPECT_TRUE(find_field_of_view(image).empty()) << "corners at " << corner;
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
    EXPECT_TRUE(find_field_of_view(cv::imread(entry.path(), cv::IMREAD_GRAYSCALE)).empty())
        << entry.path();
  }
}

}  // namespace
}  // namespace handeye
