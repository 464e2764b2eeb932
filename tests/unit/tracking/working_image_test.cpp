// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/working_image.hpp"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace handeye {
namespace {

TEST(WorkingImage, ShrinksWideImagesAlone) {
  EXPECT_EQ(WorkingImage({640, 480}).size(), cv::Size(640, 480));
  EXPECT_EQ(WorkingImage({1280, 720}).size(), cv::Size(1280, 720));
  EXPECT_EQ(WorkingImage({1920, 1080}).size(), cv::Size(960, 540));
  EXPECT_EQ(WorkingImage({3840, 2160}).size(), cv::Size(960, 540));
}

TEST(WorkingImage, MapsPositionsBackToTheGivenImage) {
  WorkingImage working({1920, 1080});
  cv::Mat grey(1080, 1920, CV_8UC1, cv::Scalar(20));
  cv::circle(grey, {800, 400}, 12, 220, cv::FILLED);
  working.prepare(grey);
  const cv::Moments moments = cv::moments(working.grey() - 20);
  const Eigen::Vector2d found = working.to_given({static_cast<float>(moments.m10 / moments.m00),
                                                  static_cast<float>(moments.m01 / moments.m00)});
  EXPECT_NEAR(found.x(), 800.0, 0.05);
  EXPECT_NEAR(found.y(), 400.0, 0.05);
}

TEST(WorkingImage, TakesTheLightOut) {
  cv::Mat texture(240, 320, CV_8UC1);
  cv::RNG random(3);
  random.fill(texture, cv::RNG::UNIFORM, 80, 160);
  cv::GaussianBlur(texture, texture, {}, 2.0);
  cv::Mat half;
  texture.convertTo(half, CV_8UC1, 0.5);
  WorkingImage bright({320, 240});
  WorkingImage dim({320, 240});
  bright.prepare(texture);
  dim.prepare(half);
  cv::Mat difference;
  cv::absdiff(bright.normalised(), dim.normalised(), difference);
  // At half the light the image is the same but for rounding and the level that protects the dark.
  EXPECT_LT(cv::mean(difference)[0], 2.0);
  EXPECT_NEAR(cv::mean(bright.normalised())[0], 128.0, 1.0);
}

}  // namespace
}  // namespace handeye
