// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/hand_stream.hpp"

#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "daemon/session/hand_path.hpp"
#include "drivers/dtrack/formatter.hpp"

namespace handeye {
namespace {

constexpr std::int64_t kPeriod_ns = 16'666'667;
constexpr std::int64_t kLatency_ns = 8'000'000;

/// A tracker's datagram: body 0 hidden, body 4 at x = `x_mm`.
std::string datagram(std::uint32_t number, std::optional<double> seconds_of_day, double x_mm) {
  dtrack::Frame frame;
  frame.number = number;
  frame.seconds_of_day = seconds_of_day;
  dtrack::Body body;
  body.id = 4;
  body.tracked = true;
  body.quality = 1;
  body.room_from_body.translation().x() = x_mm;
  frame.bodies.push_back(body);
  std::string text;
  dtrack::format_datagram(frame, text);
  return text;
}

TEST(HandStream, TakesTheConfiguredBody) {
  HandStream stream(4);
  const auto sample = stream.take({1'000'000'000, datagram(1, 100.0, 12.5)});
  ASSERT_TRUE(sample);
  EXPECT_TRUE(sample->tracked);
  EXPECT_DOUBLE_EQ(sample->room_from_hand.translation().x(), 12.5);
}

TEST(HandStream, AnAbsentBodyIsHidden) {
  HandStream stream(0);
  const auto sample = stream.take({1'000'000'000, datagram(1, 100.0, 12.5)});
  ASSERT_TRUE(sample);
  EXPECT_FALSE(sample->tracked);
  EXPECT_TRUE(stream.sample_of(4, 5).tracked) << "the other one is seen";
}

TEST(HandStream, FindsTheFirstBodyThatIsSeen) {
  HandStream stream(-1);
  ASSERT_TRUE(stream.take({1'000'000'000, datagram(1, 100.0, 12.5)}));
  EXPECT_EQ(stream.body_id(), 4);
}

TEST(HandStream, RejectsWhatIsNoDatagram) {
  HandStream stream(4);
  EXPECT_FALSE(stream.take({1'000'000'000, "GET / HTTP/1.1\r\n"}));
  EXPECT_EQ(stream.counters().rejected_datagrams, 1U);
}

TEST(HandStream, StampsByTheTrackersClockNotByArrival) {
  HandStream stream(4);
  std::int64_t last_ns = 0;
  for (std::uint32_t k = 0; k < 600; ++k) {
    const double device_s = 43'000.0 + 1e-9 * static_cast<double>(k * kPeriod_ns);
    const std::int64_t jitter_ns = k % 3 == 0 ? 0 : 3'000'000;
    const std::int64_t arrival_ns = 5'000'000'000 + k * kPeriod_ns + kLatency_ns + jitter_ns;
    const auto sample = stream.take({arrival_ns, datagram(k, device_s, 0)});
    ASSERT_TRUE(sample);
    const auto step_ns = static_cast<double>(sample->timestamp_ns - last_ns);
    if (k > 300) {
      EXPECT_NEAR(step_ns, static_cast<double>(kPeriod_ns), 50'000) << k;
    }
    last_ns = sample->timestamp_ns;
  }
}

/// One damaged ts line must not throw away what has been learnt about the clock.
TEST(HandStream, KeepsTheClockWhenOneDatagramLacksTheTime) {
  HandStream stream(4);
  constexpr std::uint32_t kOdd = 400;
  std::int64_t last_ns = 0;
  for (std::uint32_t k = 0; k < 600; ++k) {
    const double device_s = 43'000.0 + 1e-9 * static_cast<double>(k * kPeriod_ns);
    const std::int64_t jitter_ns = k % 3 == 0 ? 0 : 3'000'000;
    const std::int64_t arrival_ns = 5'000'000'000 + k * kPeriod_ns + kLatency_ns + jitter_ns;
    const auto time_s = k == kOdd ? std::nullopt : std::optional(device_s);
    const auto sample = stream.take({arrival_ns, datagram(k, time_s, 0)});
    ASSERT_TRUE(sample);
    const auto step_ns = static_cast<double>(sample->timestamp_ns - last_ns);
    const bool beside_odd = k == kOdd || k == kOdd + 1;
    if (k > 300) {
      EXPECT_NEAR(step_ns, static_cast<double>(kPeriod_ns), beside_odd ? 4e6 : 5e4) << k;
    }
    last_ns = sample->timestamp_ns;
  }
}

TEST(HandStream, FollowsASenderThatStopsSendingTheTime) {
  HandStream stream(4);
  std::int64_t arrival_ns = 5'000'000'000;
  for (std::uint32_t k = 0; k < 300; ++k, arrival_ns += kPeriod_ns) {
    stream.take({arrival_ns, datagram(k, 100.0 + 1e-9 * static_cast<double>(k * kPeriod_ns), 0)});
  }
  std::optional<HandSample> sample;
  for (std::uint32_t k = 300; k < 400; ++k, arrival_ns += kPeriod_ns) {
    sample = stream.take({arrival_ns, datagram(k, std::nullopt, 0)});
  }
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->timestamp_ns, arrival_ns - kPeriod_ns);
}

TEST(HandStream, WithoutDeviceTimeArrivalStandsForIt) {
  HandStream stream(4);
  const auto sample = stream.take({1'234'000'000, datagram(1, std::nullopt, 0)});
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->timestamp_ns, 1'234'000'000);
}

HandSample sample_at(double time_s, const Eigen::Vector3d& w, const Eigen::Vector3d& t_mm) {
  HandSample sample;
  sample.timestamp_ns = static_cast<std::int64_t>(1e9 * time_s);
  sample.tracked = true;
  sample.room_from_hand.linear() = exp_so3(w);
  sample.room_from_hand.translation() = t_mm;
  return sample;
}

TEST(HandPath, MeasuresCoverageAgainstTheFirstPose) {
  HandPath path;
  EXPECT_EQ(path.second_axis_deg(), 0);
  path.add(sample_at(0, {0, 0, 0}, {0, 0, 0}));
  path.add(sample_at(1, {rad_from_deg(10), 0, 0}, {3, 4, 0}));
  EXPECT_NEAR(path.rotation_coverage_deg(), 10, 1e-9);
  EXPECT_NEAR(path.translation_coverage_mm(), 5, 1e-9);
  EXPECT_NEAR(path.second_axis_deg(), 0, 1e-6) << "one axis only";
  path.add(sample_at(2, {0, rad_from_deg(6), 0}, {0, 0, 0}));
  EXPECT_GT(path.second_axis_deg(), 3);
}

TEST(HandPath, ThinsAndSkipsHiddenSamples) {
  HandPath path;
  for (int k = 0; k < 60; ++k) path.add(sample_at(k / 60.0, {0, 0, 0}, {0, 0, 0}));
  EXPECT_LE(path.room_from_hand().size(), 10U);
  const std::size_t before = path.room_from_hand().size();
  HandSample hidden = sample_at(9, {1, 0, 0}, {99, 0, 0});
  hidden.tracked = false;
  path.add(hidden);
  EXPECT_EQ(path.room_from_hand().size(), before);
  EXPECT_EQ(path.translation_coverage_mm(), 0);
}

}  // namespace
}  // namespace handeye
