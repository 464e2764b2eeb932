// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/hand_stream.hpp"

#include <optional>
#include <string>

#include <gtest/gtest.h>

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

/// The k-th of a tracker at 60 Hz, on time.
Datagram regular(std::uint32_t k, std::string& text) {
  text = datagram(k, 43'000.0 + 1e-9 * static_cast<double>(k * kPeriod_ns), 12.5);
  return {5'000'000'000 + k * kPeriod_ns + kLatency_ns, text};
}

TEST(HandStream, TakesTheConfiguredBody) {
  HandStream stream(4);
  std::string text;
  for (std::uint32_t k = 0; k < 2; ++k) {
    const auto sample = stream.take(regular(k, text));
    ASSERT_TRUE(sample);
    EXPECT_FALSE(sample->tracked) << "two data make no clock";
    EXPECT_TRUE(sample->doubtful_time);
  }
  const auto sample = stream.take(regular(2, text));
  ASSERT_TRUE(sample);
  EXPECT_TRUE(sample->tracked);
  EXPECT_FALSE(sample->doubtful_time);
  EXPECT_FALSE(sample->covariance) << "it says none";
  EXPECT_DOUBLE_EQ(sample->room_from_hand.translation().x(), 12.5);
}

TEST(HandStream, AJumpOfTheTrackersClockIsMarkedAndBeginsAnEpoch) {
  HandStream stream(4);
  PoseBuffer buffer;
  std::string text;
  int doubtful = 0;
  for (std::uint32_t k = 0; k < 600; ++k) {
    Datagram sent = regular(k, text);
    if (k >= 300) {
      text = datagram(k, 43'000.0 + 1e-9 * static_cast<double>(k * kPeriod_ns) - 0.1, 12.5);
      sent.bytes = text;
    }
    const auto sample = stream.take(sent);
    ASSERT_TRUE(sample);
    buffer.push(*sample);
    if (k < 10) continue;
    if (sample->doubtful_time) {
      ++doubtful;
      EXPECT_FALSE(sample->tracked);
    } else {
      EXPECT_EQ(sample->clock_epoch, k < 300 ? 0 : 1);
      const std::int64_t expected_ns = 5'000'000'000 + k * kPeriod_ns + kLatency_ns;
      EXPECT_NEAR(static_cast<double>(sample->timestamp_ns - expected_ns), 0, 1e5) << k;
    }
  }
  EXPECT_LE(doubtful, 12);
  EXPECT_GE(doubtful, 3);
  EXPECT_EQ(stream.clock_report().jumps, 1);
  const std::int64_t jump_ns = 5'000'000'000 + 300 * kPeriod_ns + kLatency_ns;
  EXPECT_EQ(buffer.lookup(jump_ns - kPeriod_ns / 2).status, LookupStatus::kGap);
}

TEST(HandStream, DatagramsOvertakenOnTheWayFindTheirPlace) {
  HandStream stream(4);
  PoseBuffer buffer;
  std::string text;
  for (std::uint32_t k = 0; k < 300; ++k) {
    // Every fifth comes after its two successors.
    const std::uint32_t number = k % 5 == 0 ? k + 1 : k % 5 == 1 ? k + 1 : k % 5 == 2 ? k - 2 : k;
    Datagram sent = regular(number, text);
    if (number < k) sent.arrival_ns += (k - number) * kPeriod_ns;
    const auto sample = stream.take(sent);
    ASSERT_TRUE(sample);
    buffer.push(*sample);
    if (k % 50 == 7) buffer.push(*stream.take(sent));  // and some come twice
  }
  EXPECT_EQ(buffer.reordered(), 59U) << "the first was of doubtful time";
  EXPECT_EQ(buffer.duplicates(), 6U);
  EXPECT_EQ(buffer.out_of_order(), 0U);
  for (std::size_t i = 1; i < buffer.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(buffer.at(i).timestamp_ns - buffer.at(i - 1).timestamp_ns),
                static_cast<double>(kPeriod_ns), 1e3);
  }
}

TEST(HandStream, AnAbsentBodyIsHidden) {
  HandStream stream(0);
  const auto sample = stream.take({1'000'000'000, datagram(1, 100.0, 12.5)});
  ASSERT_TRUE(sample);
  EXPECT_FALSE(sample->tracked);
  EXPECT_EQ(stream.sample_of(4).room_from_hand.translation().x(), 12.5) << "the other one is seen";
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

}  // namespace
}  // namespace handeye
