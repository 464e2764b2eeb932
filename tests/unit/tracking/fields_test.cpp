// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/fields.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "tests/unit/tracking/moving_texture.hpp"

namespace handeye {
namespace {

using test::MovingTexture;

const cv::Size kSize(640, 480);

/// Even lines of one picture, odd ones of another.
cv::Mat woven(const cv::Mat& even, const cv::Mat& odd) {
  cv::Mat image = odd.clone();
  for (int y = 0; y < image.rows; y += 2) even.row(y).copyTo(image.row(y));
  return image;
}

cv::Mat noisy(const cv::Mat& grey, double sigma, unsigned seed) {
  cv::Mat noise(grey.size(), CV_32FC1);
  cv::RNG random(seed);
  random.fill(noise, cv::RNG::NORMAL, 0, sigma);
  cv::Mat sum;
  cv::add(grey, noise, sum, cv::noArray(), CV_32F);
  sum.convertTo(sum, CV_8U);
  return sum;
}

cv::Mat shifted(const cv::Mat& image, double x_px, double y_px) {
  const cv::Matx23d shift(1, 0, x_px, 0, 1, y_px);
  cv::Mat moved;
  cv::warpAffine(image, moved, shift, image.size(), cv::INTER_CUBIC, cv::BORDER_REFLECT_101);
  return moved;
}

/// Mottled as tissue is, nothing smaller than some ten pixels.
cv::Mat soft_picture() {
  cv::Mat picture = MovingTexture(kSize).image(0);
  cv::GaussianBlur(picture, picture, {}, 5);
  cv::normalize(picture, picture, 30, 220, cv::NORM_MINMAX);
  return picture;
}

class Movement : public testing::TestWithParam<cv::Point2d> {};

TEST_P(Movement, BetweenTheFieldsIsMeasured) {
  const cv::Mat picture = soft_picture();
  const cv::Point2d by = GetParam();
  const Combing combing =
      CombingMeter().measure(noisy(woven(picture, shifted(picture, by.x, by.y)), 1.5, 1));
  EXPECT_TRUE(combing.is_clear()) << combing.explained << ", " << combing.movement_px << " px";
  const double truth_px = std::hypot(by.x, by.y);
  if (truth_px < 1.5) {
    EXPECT_NEAR(combing.movement_px, truth_px, 0.35 * truth_px);
  }
}

INSTANTIATE_TEST_SUITE_P(Fields, Movement,
                         testing::Values(cv::Point2d(1, 0), cv::Point2d(0, -1),
                                         cv::Point2d(0.8, 0.8), cv::Point2d(-3, 1),
                                         cv::Point2d(0, 3), cv::Point2d(6, 0)));

TEST(FieldSeparation, NoticesInterlacedImagesWithinThree) {
  const MovingTexture texture(kSize);
  FieldSeparation fields;
  for (int frame = 0; frame < 12; ++frame) {
    const cv::Mat image = noisy(woven(texture.image(frame), texture.image(frame + 1)), 1.5,
                                static_cast<unsigned>(frame));
    const cv::Mat& used = fields.take(image);
    EXPECT_EQ(fields.used_one_field(), frame >= 2) << frame;
    EXPECT_EQ(used.data == image.data, !fields.used_one_field());
  }
  // It holds while the camera stands still, when nothing shows.
  const cv::Mat still = texture.image(12);
  fields.take(still);
  EXPECT_TRUE(fields.used_one_field());
}

TEST(FieldSeparation, IsGivenUpWhenAllIsClearAgain) {
  const MovingTexture texture(kSize);
  FieldSeparation fields;
  for (int frame = 0; frame < 3; ++frame) {
    fields.take(woven(texture.image(frame), texture.image(frame + 1)));
  }
  ASSERT_TRUE(fields.used_one_field());
  int one_field = 0;
  for (int frame = 0; frame < 150; ++frame) {
    fields.take(texture.image(frame % 40));
    one_field += fields.used_one_field();
  }
  EXPECT_GT(one_field, 50) << "a rest of two seconds is no reason";
  EXPECT_LT(one_field, 110);
  EXPECT_FALSE(fields.used_one_field());
}

TEST(FieldSeparation, HoldsWhileMovementComesAndGoes) {
  const MovingTexture texture(kSize);
  FieldSeparation fields;
  for (int frame = 0; frame < 400; ++frame) {
    const bool moves = frame % 50 < 25;
    const int shown = frame % 25;
    fields.take(moves ? woven(texture.image(shown), texture.image(shown + 1))
                      : texture.image(shown));
    EXPECT_EQ(fields.used_one_field(), frame >= 2) << frame;
  }
}

TEST(FieldSeparation, LeavesProgressiveImagesAlone) {
  const MovingTexture texture(kSize);
  for (const double sigma : {0.0, 1.5, 5.0}) {
    FieldSeparation fields;
    for (int frame = 0; frame < 40; ++frame) {
      const cv::Mat image = noisy(texture.image(frame), sigma, static_cast<unsigned>(frame));
      EXPECT_EQ(fields.take(image).data, image.data) << sigma << " " << frame;
      EXPECT_FALSE(fields.used_one_field());
    }
  }
}

// What makes simple measures of combing fail: lines of a period of two rows, or near it.
TEST(FieldSeparation, IsNotFooledByATextureOfLines) {
  const MovingTexture texture(kSize);
  for (const double period_px : {2.0, 2.1, 2.5, 3.0, 4.0, 7.0}) {
    for (const double tilt : {0.0, 0.05, 0.5}) {
      FieldSeparation fields;
      for (int frame = 0; frame < 30; ++frame) {
        cv::Mat image = texture.image(frame);
        for (int y = 0; y < image.rows; ++y) {
          for (int x = 0; x < image.cols; ++x) {
            const double phase = (y + 0.37 * frame + tilt * x) / period_px;
            auto& pixel = image.at<std::uint8_t>(y, x);
            pixel = cv::saturate_cast<std::uint8_t>(pixel + 25 * std::cos(2 * CV_PI * phase));
          }
        }
        fields.take(image);
        EXPECT_FALSE(fields.used_one_field()) << period_px << " " << tilt << " " << frame;
      }
    }
  }
}

TEST(FieldSeparation, IsNotFooledByFieldsOfDifferentBrightness) {
  const MovingTexture texture(kSize);
  FieldSeparation fields;
  for (int frame = 0; frame < 20; ++frame) {
    const cv::Mat image = texture.image(frame);
    fields.take(woven(image, image * 0.9));
    EXPECT_FALSE(fields.used_one_field()) << frame;
  }
}

TEST(FieldSeparation, SaysNothingOfSmallOrEmptyImages) {
  FieldSeparation fields;
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(16, 12), cv::Size(640, 480)}) {
    const cv::Mat image(size, CV_8UC1, cv::Scalar(90));
    EXPECT_EQ(fields.take(image).data, image.data);
  }
}

TEST(EvenField, KeepsEvenLinesAndDoesNotKnowTheOddOnes) {
  const MovingTexture texture(kSize);
  const cv::Mat even = texture.image(0);
  cv::Mat of_one;
  cv::Mat of_other;
  keep_even_field(woven(even, texture.image(9)), of_one);
  keep_even_field(woven(even, cv::Mat(kSize, CV_8UC1, cv::Scalar(255))), of_other);
  EXPECT_EQ(cv::norm(of_one, of_other, cv::NORM_INF), 0);
  for (int y = 0; y < even.rows; y += 2) {
    ASSERT_EQ(cv::norm(even.row(y), of_one.row(y), cv::NORM_INF), 0) << y;
  }
}

TEST(EvenField, IsExactOnASlope) {
  for (const int rows : {2, 3, 7, 8, 64, 65}) {
    cv::Mat image(rows, 40, CV_8UC1);
    for (int y = 0; y < rows; ++y) image.row(y).setTo(3 * y + 10);
    cv::Mat field;
    keep_even_field(image, field);
    // Near the upper and lower end lines are missing to interpolate from.
    for (int y = 3; y < rows - 4; ++y) EXPECT_EQ(field.at<std::uint8_t>(y, 20), 3 * y + 10) << rows;
  }
}

// Where a blob is must not depend on which field its middle lies in, nor move by half a line.
TEST(EvenField, KeepsPixelCoordinates) {
  for (double middle = 40.0; middle < 42.0; middle += 0.25) {
    cv::Mat image(80, 80, CV_8UC1);
    for (int y = 0; y < 80; ++y) {
      for (int x = 0; x < 80; ++x) {
        const double r2 = std::pow(x - 40.0, 2) + std::pow(y - middle, 2);
        image.at<std::uint8_t>(y, x) =
            cv::saturate_cast<std::uint8_t>(20 + 200 * std::exp(-r2 / (2 * 2.5 * 2.5)));
      }
    }
    cv::Mat field;
    keep_even_field(image, field);
    cv::Mat excess;
    field.convertTo(excess, CV_32F, 1, -20);
    const cv::Moments moments = cv::moments(excess);
    EXPECT_NEAR(moments.m01 / moments.m00, middle, 0.02) << middle;
    EXPECT_NEAR(moments.m10 / moments.m00, 40.0, 0.02) << middle;
  }
}

}  // namespace
}  // namespace handeye
