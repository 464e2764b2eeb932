// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/highlights.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/unit/tracking/moving_texture.hpp"

namespace handeye {
namespace {

using test::MovingTexture;

/// Tissue: softly shaded and mottled, between about 70 and 150.
cv::Mat tissue(cv::Size size) {
  cv::Mat image = MovingTexture(size).image(0);
  image.convertTo(image, CV_8U, 0.3, 75);
  return image;
}

/// A hill of light whose middle reaches `top`; clipped at 255.
cv::Mat hill(cv::Size size, double top, double radius_px) {
  cv::Mat image(size, CV_8UC1);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const double r = std::hypot(x - 0.5 * size.width, y - 0.5 * size.height) / radius_px;
      image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(top * std::exp(-0.5 * r * r));
    }
  }
  return image;
}

double share_taken(const cv::Mat& usable) {
  if (usable.empty()) return 0;
  return 1.0 - cv::countNonZero(usable) / static_cast<double>(usable.total());
}

class SizeOf : public testing::TestWithParam<cv::Size> {};

TEST_P(SizeOf, SpotsAreTakenWithTheirSkirtsAndNoMore) {
  const cv::Size size = GetParam();
  const double px = size.width / 640.0;
  cv::Mat image = tissue(size);
  cv::Mat spots = cv::Mat::zeros(size, CV_8UC1);
  for (int k = 0; k < 12; ++k) {
    const cv::Point at(size.width * (1 + k % 4) / 5, size.height * (1 + k / 4) / 4);
    cv::ellipse(spots, at, {cvRound((2 + k) * px), cvRound(3 * px)}, 30.0 * k, 0, 360, 255,
                cv::FILLED);
  }
  image.setTo(255, spots);
  cv::GaussianBlur(image, image, {}, 0.8 * px);

  Highlights highlights;
  const cv::Mat& usable = highlights.usable(image, {});
  ASSERT_EQ(usable.size(), size);
  ASSERT_EQ(usable.type(), CV_8UC1);
  EXPECT_EQ(cv::countNonZero((usable != 0) & (usable != 255)), 0);
  cv::Mat distance;
  cv::distanceTransform(~spots, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  // The skirt is gone, what is farther away than the widest dilation allowed stays.
  EXPECT_EQ(cv::countNonZero((distance < 2 * px) & usable), 0);
  EXPECT_EQ(cv::countNonZero((distance > 11 * px) & ~usable), 0);
}

INSTANTIATE_TEST_SUITE_P(Images, SizeOf,
                         testing::Values(cv::Size(640, 480), cv::Size(1280, 720),
                                         cv::Size(1920, 1080), cv::Size(721, 577)));

TEST(Highlights, LeaveBrightTissueInUse) {
  const cv::Size size(640, 480);
  Highlights highlights;
  EXPECT_TRUE(highlights.usable(tissue(size), {}).empty());
  EXPECT_TRUE(highlights.usable(hill(size, 245, 120), {}).empty());
  EXPECT_TRUE(highlights.usable(MovingTexture(size).image(0), {}).empty()) << "up to 200";
  // With a texture on it, and noise.
  cv::Mat bright = hill(size, 200, 200) + tissue(size) * 0.3;
  cv::Mat noise(size, CV_8UC1);
  cv::RNG random(3);
  random.fill(noise, cv::RNG::NORMAL, 4, 3);
  EXPECT_LT(share_taken(highlights.usable(bright + noise, {})), 0.002);
}

TEST(Highlights, TakeWhatIsClipped) {
  const cv::Size size(640, 480);
  const cv::Mat image = hill(size, 400, 120);
  Highlights highlights;
  const cv::Mat& usable = highlights.usable(image, {});
  EXPECT_EQ(cv::countNonZero((image == 255) & usable), 0);
  // Not the slope below.
  cv::Mat distance;
  cv::distanceTransform(image < 250, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  EXPECT_EQ(cv::countNonZero((distance > 11) & ~usable), 0);
}

TEST(Highlights, WhereThePictureIsDimmerAreTakenToo) {
  const cv::Size size(640, 480);
  cv::Mat image = tissue(size) * 0.6;
  cv::circle(image, {100, 100}, 5, 215, cv::FILLED);
  const cv::Mat& usable = Highlights().usable(image, {}).clone();
  ASSERT_FALSE(usable.empty());
  EXPECT_EQ(usable.at<std::uint8_t>(100, 100), 0);
}

TEST(Highlights, StayWithinTheFieldOfView) {
  const cv::Size size(640, 480);
  cv::Mat field = cv::Mat::zeros(size, CV_8UC1);
  cv::circle(field, {320, 240}, 200, 255, cv::FILLED);
  cv::Mat image = tissue(size);
  Highlights highlights;
  EXPECT_EQ(highlights.usable(image, field).data, field.data) << "without a spot it is the field";
  cv::circle(image, {320, 240}, 6, 255, cv::FILLED);
  const cv::Mat& usable = highlights.usable(image, field);
  EXPECT_EQ(cv::countNonZero(usable & ~field), 0);
  EXPECT_EQ(usable.at<std::uint8_t>(240, 320), 0);
  EXPECT_EQ(usable.at<std::uint8_t>(300, 320), 255);
  // The memory is the same from image to image.
  const auto* memory = usable.data;
  EXPECT_EQ(highlights.usable(image, field).data, memory);
}

TEST(Highlights, AreFoundAtTheImagesBorder) {
  for (const cv::Point at : {cv::Point(0, 0), cv::Point(639, 479), cv::Point(320, 0)}) {
    cv::Mat image = tissue({640, 480});
    cv::circle(image, at, 6, 255, cv::FILLED);
    const cv::Mat usable = Highlights().usable(image, {}).clone();
    ASSERT_FALSE(usable.empty());
    EXPECT_EQ(usable.at<std::uint8_t>(at), 0);
    EXPECT_EQ(usable.at<std::uint8_t>(240, 320), 255);
  }
}

TEST(Highlights, TakeImagesOfAnySize) {
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(5, 400), cv::Size(333, 7)}) {
    Highlights highlights;
    highlights.usable(cv::Mat(size, CV_8UC1, cv::Scalar(255)), {});
    highlights.usable(cv::Mat(size, CV_8UC1, cv::Scalar(40)), {});
  }
}

// The colour, which the daemon does not have, says what truly is one: bright and white.
TEST(Highlights, OfARealEndoscope) {
  const char* configured = std::getenv("HANDEYE_DATA");
  const auto data = configured != nullptr
                        ? std::filesystem::path(configured)
                        : std::filesystem::path(HANDEYE_SOURCE_DIR) / "../shared/data";
  const auto folder = data / "sinus";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there: set HANDEYE_DATA";
  const cv::Mat field = cv::imread(folder / "mask.png", cv::IMREAD_GRAYSCALE);
  int files = 0;
  double white = 0, white_taken = 0, other = 0, other_taken = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "frames")) {
    if (++files % 3 != 0) continue;
    const cv::Mat colour = cv::imread(entry.path());
    cv::Mat grey;
    cv::cvtColor(colour, grey, cv::COLOR_BGR2GRAY);
    cv::Mat hsv;
    cv::cvtColor(colour, hsv, cv::COLOR_BGR2HSV);
    cv::Mat mirrored;
    cv::inRange(hsv, cv::Scalar(0, 0, 236), cv::Scalar(255, 39, 255), mirrored);
    mirrored &= field;
    // A sharp white spot has a soft rim, which is rightly taken as well.
    cv::Mat about;
    cv::dilate(mirrored, about, cv::getStructuringElement(cv::MORPH_ELLIPSE, {33, 33}));
    const cv::Mat rest = field & ~about;
    const cv::Mat taken = field & ~Highlights().usable(grey, field);
    white += cv::countNonZero(mirrored);
    white_taken += cv::countNonZero(mirrored & taken);
    other += cv::countNonZero(rest);
    other_taken += cv::countNonZero(rest & taken);
  }
  EXPECT_GT(white_taken, 0.9 * white);
  EXPECT_LT(other_taken, 0.04 * other);
  RecordProperty("white_taken_percent", static_cast<int>(100 * white_taken / white));
  RecordProperty("other_taken_permille", static_cast<int>(1000 * other_taken / other));
}

}  // namespace
}  // namespace handeye
