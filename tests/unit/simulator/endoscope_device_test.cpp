// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/endoscope_device.hpp"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

namespace handeye::simulator {
namespace {

constexpr std::int64_t kStartNs = 9'000'000'000;

SimulatorOptions options_of(std::uint64_t seed) {
  SimulatorOptions options;
  options.seed = seed;
  return options;
}

TEST(EndoscopeDevice, StampsMidExposureLateByItsDelay) {
  const World world(options_of(5), kStartNs);
  EndoscopeDevice endoscope(world);
  SimulatedFrame frame;
  for (const std::uint32_t number : {0U, 1U, 250U}) {
    endoscope.make(number, frame);
    EXPECT_EQ(frame.number, number);
    EXPECT_DOUBLE_EQ(frame.exposed_s, number / 25.0);
    EXPECT_NEAR(1e-9 * static_cast<double>(frame.timestamp_ns - kStartNs),
                number / 25.0 + world.camera_delay_s, 2e-9);
    EXPECT_GE(frame.arrival_ns, frame.timestamp_ns);
    EXPECT_EQ(frame.timestamp_ns, endoscope.timestamp_ns(number));
  }
}

TEST(EndoscopeDevice, FramesDoNotDependOnTheOrderTheyAreMadeIn) {
  const World world(options_of(5), kStartNs);
  EndoscopeDevice forward(world);
  EndoscopeDevice backward(world);
  SimulatedFrame first;
  SimulatedFrame last;
  SimulatedFrame first_again;
  SimulatedFrame last_again;
  forward.make(3, first);
  forward.make(90, last);
  backward.make(90, last_again);
  backward.make(3, first_again);
  EXPECT_EQ(first.jpeg, first_again.jpeg);
  EXPECT_EQ(last.jpeg, last_again.jpeg);
  EXPECT_NE(first.jpeg, last.jpeg);
}

TEST(EndoscopeDevice, JpegIsTheImage) {
  const World world(options_of(6), kStartNs);
  EndoscopeDevice endoscope(world);
  SimulatedFrame frame;
  endoscope.make(10, frame);
  const cv::Mat decoded = cv::imdecode(frame.jpeg, cv::IMREAD_UNCHANGED);
  ASSERT_EQ(decoded.size(), frame.grey.size());
  ASSERT_EQ(decoded.type(), CV_8UC1);
  EXPECT_LT(cv::norm(decoded, frame.grey, cv::NORM_L1) / static_cast<double>(decoded.total()), 2.0);
}

TEST(EndoscopeDevice, JpegsStayBelow100kB) {
  SimulatorOptions options = options_of(6);
  const World small(options, kStartNs);
  EndoscopeDevice small_endoscope(small);
  SimulatedFrame frame;
  for (std::uint32_t number = 0; number < 500; number += 50) {
    small_endoscope.make(number, frame);
    EXPECT_LT(frame.jpeg.size(), kLargestJpegBytes);
  }
  options.width = 1280;
  options.height = 720;
  options.jpeg_quality = 100;
  const World large(options, kStartNs);
  EndoscopeDevice large_endoscope(large);
  large_endoscope.make(1, frame);
  EXPECT_LT(frame.jpeg.size(), kLargestJpegBytes);
  EXPECT_EQ(cv::imdecode(frame.jpeg, cv::IMREAD_UNCHANGED).size(), cv::Size(1280, 720));
}

}  // namespace
}  // namespace handeye::simulator
