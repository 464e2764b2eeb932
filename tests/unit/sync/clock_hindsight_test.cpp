// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/sync/clock_hindsight.hpp"

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace handeye {
namespace {

constexpr double kRate_hz = 60;
constexpr double kLatency_s = 0.007;
constexpr std::int64_t kBoot_ns = 5'000'000'000'000;

/// Samples as a tracker's stream makes them; the pose tells when it was measured.
struct Stream {
  PoseBuffer samples;
  double drift{30e-6};
  double jitter_s{0.001};
  double extra_late_s{0};
  double jump_s{0};

  explicit Stream(std::uint32_t seed) : random_(seed) {}

  void run(double from_s, double to_s) {
    for (int i = 0; i < std::lround((to_s - from_s) * kRate_hz); ++i) {
      const double time_s = from_s + i / kRate_hz;
      const double arrival_s =
          time_s + kLatency_s + extra_late_s + jitter_s * exponential_(random_);
      const ClockReading reading = clock_.observe(4000 + (1 + drift) * time_s + jump_s,
                                                  kBoot_ns + std::llround(1e9 * arrival_s));
      HandSample sample{.timestamp_ns = reading.timestamp_ns, .tracked = !reading.doubtful};
      sample.room_from_hand.translation().x() = time_s;
      sample.doubtful_time = reading.doubtful;
      sample.clock_epoch = clock_.epoch();
      if (!reading.doubtful) sample.clock_mapping = reading.mapping;
      samples.push(sample);
    }
  }

 private:
  ClockModel clock_;
  std::mt19937 random_;
  std::exponential_distribution<double> exponential_{1.0};
};

double error_s(const HandSample& sample) {
  return 1e-9 * static_cast<double>(sample.timestamp_ns - kBoot_ns) - kLatency_s -
         sample.room_from_hand.translation().x();
}

double largest_s(const PoseBuffer& samples, double from_s, double to_s) {
  double largest = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double time_s = samples.at(i).room_from_hand.translation().x();
    if (time_s >= from_s && time_s < to_s) {
      largest = std::max(largest, std::abs(error_s(samples.at(i))));
    }
  }
  return largest;
}

double mean_s(const PoseBuffer& samples) {
  double sum = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) sum += error_s(samples.at(i));
  return sum / static_cast<double>(samples.size());
}

TEST(ClockHindsight, TheFirstSecondIsAsGoodAsTheRest) {
  double at_once_s = 0;
  double later_s = 0;
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    Stream stream(seed);
    stream.run(0, 20);
    const PoseBuffer samples = with_hindsight(stream.samples);
    ASSERT_EQ(samples.size(), stream.samples.size());
    EXPECT_LT(largest_s(samples, 0, 20), 0.1e-3) << seed;
    EXPECT_LT(std::abs(mean_s(samples)), 0.03e-3) << seed;
    at_once_s += largest_s(stream.samples, 0, 1) / 50;
    later_s += largest_s(samples, 0, 1) / 50;
  }
  EXPECT_GT(at_once_s, 0.15e-3) << "or there would be nothing to put right";
  EXPECT_LT(later_s, 0.05e-3);
}

/// What a sample is stamped by does not change any more once it is 10 s old.
TEST(ClockHindsight, OldStampsStay) {
  Stream stream(3);
  stream.run(0, 30);
  const PoseBuffer before = with_hindsight(stream.samples);
  stream.run(30, 60);
  const PoseBuffer after = with_hindsight(stream.samples);
  for (std::size_t i = 0; i < 19 * static_cast<std::size_t>(kRate_hz); ++i) {
    ASSERT_EQ(before.at(i).timestamp_ns, after.at(i).timestamp_ns) << i;
  }
}

TEST(ClockHindsight, LeavesWhatIsNoRefinement) {
  for (const double longer_s : {0.005, -0.005}) {
    Stream stream(4);
    stream.run(0, 30);
    stream.extra_late_s = longer_s;
    stream.run(30, 80);
    const PoseBuffer samples = with_hindsight(stream.samples);
    ASSERT_EQ(samples.size(), stream.samples.size()) << "none overtakes another";
    for (std::size_t i = 0; i < samples.size(); ++i) {
      EXPECT_LE(std::abs(samples.at(i).timestamp_ns - stream.samples.at(i).timestamp_ns),
                2'500'000);
    }
  }
}

TEST(ClockHindsight, DoesNotLookAcrossAJumpOrALongPause) {
  for (const double jump_s : {0.0, 0.3}) {
    Stream stream(5);
    stream.run(0, 15);
    const double after_s = jump_s == 0 ? 100 : 15;  // longer than the model's window
    const PoseBuffer before = with_hindsight(stream.samples);
    stream.jump_s = jump_s;
    stream.run(after_s, after_s + 15);
    const PoseBuffer samples = with_hindsight(stream.samples);
    for (std::size_t i = 0; i < before.size(); ++i) {
      ASSERT_EQ(samples.at(i).timestamp_ns, before.at(i).timestamp_ns) << i;
    }
    EXPECT_LT(largest_s(samples, 0, after_s + 15), 0.1e-3);
  }
}

TEST(ClockHindsight, LeavesStampsOfNoClock) {
  PoseBuffer arrivals;
  for (std::int64_t i = 0; i < 5; ++i) {
    arrivals.push({.timestamp_ns = 1'000'000 + 16'000'000 * i, .tracked = true});
  }
  const PoseBuffer samples = with_hindsight(arrivals);
  ASSERT_EQ(samples.size(), arrivals.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(samples.at(i).timestamp_ns, arrivals.at(i).timestamp_ns);
  }
  EXPECT_EQ(with_hindsight(PoseBuffer()).size(), 0U);
}

}  // namespace
}  // namespace handeye
