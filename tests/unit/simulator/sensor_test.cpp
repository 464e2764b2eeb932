// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/sensor.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/simulator/disturbed_world.hpp"

namespace handeye::simulator {
namespace {

TEST(Sensor, NoiseHasTheStandardDeviationAskedForAndIsNewInEveryFrame) {
  const cv::Mat1f radiance(240, 320, 0.5F);
  const double grey_level = static_cast<double>(tone(0.5F));
  const Sensor sensor(radiance.cols, 4, 4.0);
  cv::Mat first;
  cv::Mat second;
  sensor.expose(radiance, 1, {}, first);
  sensor.expose(radiance, 2, {}, second);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(first, mean, deviation);
  EXPECT_NEAR(mean[0], grey_level, 0.1);
  EXPECT_NEAR(deviation[0], 4.0, 0.1);
  cv::Mat difference;
  cv::subtract(first, second, difference, cv::noArray(), CV_32F);
  cv::meanStdDev(difference, mean, deviation);
  EXPECT_NEAR(deviation[0], 4.0 * std::sqrt(2.0), 0.15);
}

TEST(Sensor, LightGainChangesMidGreyByItsFactor) {
  const Sensor sensor(8, 4, 0.0);
  const float mid_grey = 1.3F * 120.0F / (470.0F - 120.0F);
  cv::Mat grey;
  for (const double factor : {0.65, 1.0, 1.35}) {
    sensor.expose(cv::Mat1f(8, 8, mid_grey), 0, {static_cast<float>(light_gain_of(factor)), 0},
                  grey);
    EXPECT_NEAR(cv::mean(grey)[0], 120.0 * factor, 0.6);
    sensor.expose(cv::Mat1f(8, 8, mid_grey), 0, {static_cast<float>(light_gain_of(factor)), 7.0F},
                  grey);
    EXPECT_NEAR(cv::mean(grey)[0], 120.0 * factor + 7.0, 0.6);
  }
}

TEST(Flicker, GoesFromEndToEndWithinASecond) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Flicker flicker(0.35, seed);
    for (double begin_s = 0; begin_s < 20; begin_s += 0.5) {
      double lowest = 2;
      double highest = 0;
      double largest_step = 0;
      for (double time_s = begin_s; time_s < begin_s + 1.25; time_s += 0.04) {
        lowest = std::min(lowest, flicker.grey_gain(time_s));
        highest = std::max(highest, flicker.grey_gain(time_s));
        largest_step = std::max(
            largest_step, std::abs(flicker.grey_gain(time_s + 0.04) - flicker.grey_gain(time_s)));
      }
      EXPECT_GE(lowest, 0.65);
      EXPECT_LE(highest, 1.35);
      EXPECT_GT(highest - lowest, 0.6);
      EXPECT_LT(largest_step, 0.15);  // smooth
    }
  }
  EXPECT_EQ(Flicker(0, 1).exposure(3.1).gain, 1.0F);
  EXPECT_EQ(Flicker(0, 1).exposure(3.1).offset_grey, 0.0F);
}

TEST(Flicker, ShowsInThePicturesAsSaid) {
  SimulatorOptions options = quiet_options(9);
  const World steady(options, 0);
  options.disturbances.flicker = 0.35;
  const World flickering(options, 0);
  EndoscopeView steady_view(steady);
  EndoscopeView flickering_view(flickering);
  double lowest = 2;
  double highest = 0;
  for (std::uint32_t number = 0; number < 30; ++number) {
    const double ratio =
        cv::mean(drawn(flickering_view, number))[0] / cv::mean(drawn(steady_view, number))[0];
    lowest = std::min(lowest, ratio);
    highest = std::max(highest, ratio);
  }
  EXPECT_NEAR(lowest, 0.65, 0.08);
  EXPECT_NEAR(highest, 1.35, 0.08);
}

}  // namespace
}  // namespace handeye::simulator
