// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/sync/clock_model.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace handeye {
namespace {

constexpr double kDay_s = 86400.0;
constexpr double kLatency_s = 0.004;

/// A device whose clock runs at (1 + drift) of the host's, and a network that delays each datagram
/// by a constant and an exponential jitter.
class Device {
 public:
  explicit Device(std::uint32_t seed, double jitter_s = 1e-3)
      : generator_(seed), jitter_s_(jitter_s) {}

  double start_of_day_s{40000.0};
  double drift{0};
  double jump_s{0};        ///< added to the device's clock
  double extra_late_s{0};  ///< of the next datagram only

  std::optional<std::uint32_t> tick;  ///< of the last datagram; nothing: it does not count
  bool doubtful{false};               ///< the last answer

  /// Runs the measurement at `time_s` of the host's clock through the model; returns how late the
  /// model's answer is, the constant latency taken off [s].
  double error_at(ClockModel& model, double time_s) {
    const double device_s = std::fmod(start_of_day_s + (1 + drift) * time_s + jump_s, kDay_s);
    const double arrival_s =
        time_s + kLatency_s + extra_late_s + jitter_s_ * exponential_(generator_);
    extra_late_s = 0;
    const std::int64_t arrival_ns = kBoot_ns + std::llround(arrival_s * 1e9);
    if (tick) ++*tick;
    const ClockReading reading = model.observe(device_s, arrival_ns, tick);
    doubtful = reading.doubtful;
    EXPECT_LE(reading.timestamp_ns, arrival_ns + (doubtful ? 0 : 1'000'000));
    return static_cast<double>(reading.timestamp_ns - kBoot_ns) * 1e-9 - time_s - kLatency_s;
  }

 private:
  static constexpr std::int64_t kBoot_ns = 7'000'000'000'000;
  std::mt19937 generator_;
  std::exponential_distribution<double> exponential_{1.0};
  double jitter_s_;
};

struct Spread {
  double largest_s{0};   ///< of those that are not doubtful
  double rms_jerk_s{0};  ///< of the change of the error from one sample to the next
  int doubtful{0};
};

Spread run(ClockModel& model, Device& device, double from_s, double to_s, double rate_hz = 60) {
  Spread spread;
  double sum = 0;
  std::optional<double> last;
  int n = 0;
  const auto samples = static_cast<int>(std::lround((to_s - from_s) * rate_hz));
  for (int i = 0; i < samples; ++i) {
    const double error = device.error_at(model, from_s + i / rate_hz);
    if (device.doubtful) {
      ++spread.doubtful;
      last.reset();
      continue;
    }
    spread.largest_s = std::max(spread.largest_s, std::abs(error));
    if (last) {
      sum += (error - *last) * (error - *last);
      ++n;
    }
    last = error;
  }
  spread.rms_jerk_s = std::sqrt(sum / std::max(n, 1));
  return spread;
}

TEST(ClockModel, ConvergesWithinTwoSecondsOfJitteryData) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    for (const double drift : {-100e-6, 0.0, 100e-6}) {
      ClockModel model;
      Device device(seed);
      device.drift = drift;
      run(model, device, 0, 2);
      EXPECT_LT(run(model, device, 2, 10).largest_s, 0.2e-3) << seed << " drift " << drift;
      const Spread settled = run(model, device, 10, 60);
      EXPECT_LT(settled.largest_s, 0.05e-3) << seed << " drift " << drift;
      EXPECT_LT(settled.rms_jerk_s, 2e-6) << seed << " drift " << drift;
      EXPECT_EQ(model.jumps(), 0);
    }
  }
}

TEST(ClockModel, ReportsTheDrift) {
  ClockModel model;
  Device device(1);
  device.drift = 80e-6;
  run(model, device, 0, 30);
  EXPECT_NEAR(model.drift(), 80e-6, 10e-6);
}

TEST(ClockModel, NeverRunsBackwardsAndNeverJumps) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    ClockModel model;
    Device device(seed, 5e-3);
    std::optional<double> last;
    for (int i = 0; i < 1200; ++i) {
      const double error = device.error_at(model, i / 60.0);
      if (last && !device.doubtful) {
        EXPECT_LT(std::abs(error - *last), 0.5 / 60.0) << "sample " << i;  // so time advances
        if (i > 60) {
          EXPECT_LT(std::abs(error - *last), 0.1e-3) << "sample " << i;
        }
      }
      last = error;
      if (device.doubtful) last.reset();
    }
  }
}

TEST(ClockModel, PassesMidnight) {
  ClockModel model;
  Device device(2);
  device.start_of_day_s = kDay_s - 5;
  run(model, device, 0, 4);
  EXPECT_LT(run(model, device, 4, 10).largest_s, 0.1e-3);
  EXPECT_EQ(model.jumps(), 0);
}

TEST(ClockModel, PassesMidnightDuringALongPause) {
  ClockModel model;
  Device device(3);
  run(model, device, 0, 4);
  const double after_s = 14 * 3600.0;  // 1 ppm of drift stays below a jump
  run(model, device, after_s, after_s + 2);
  EXPECT_LT(run(model, device, after_s + 2, after_s + 4).largest_s, 0.2e-3);
  EXPECT_EQ(model.jumps(), 0);
}

TEST(ClockModel, BridgesGaps) {
  ClockModel model;
  Device device(4);
  device.drift = 50e-6;
  run(model, device, 0, 10);
  EXPECT_LT(run(model, device, 15, 20).largest_s, 0.1e-3);
  // 17 s on, an error of the drift of some ppm has grown to a quarter of a millisecond.
  EXPECT_LT(run(model, device, 37, 39).largest_s, 0.5e-3);
  EXPECT_LT(run(model, device, 39, 42).largest_s, 0.1e-3);
  EXPECT_EQ(model.jumps(), 0);
}

TEST(ClockModel, RestartsWhenTheDeviceClockJumps) {
  for (const bool counts : {false, true}) {
    for (const double jump_s : {-7.0, -0.2, -0.06, 0.06, 0.2, 3600.0}) {
      ClockModel model;
      Device device(5);
      if (counts) device.tick = 77;
      run(model, device, 0, 5);
      device.jump_s = jump_s;
      const Spread after = run(model, device, 5, 7);
      EXPECT_EQ(model.jumps(), 1) << jump_s;
      EXPECT_EQ(model.epoch(), 1) << jump_s;
      EXPECT_LT(after.largest_s, 5e-3) << jump_s;
      EXPECT_LE(after.doubtful, 25) << jump_s << " of 120";
      EXPECT_LT(run(model, device, 7, 12).largest_s, 0.2e-3) << jump_s;
    }
  }
}

/// Against a counter even steps show that are lost in the network's jitter.
TEST(ClockModel, WithACounterSmallStepsShow) {
  for (const double jump_s : {-0.03, -0.01, 0.01, 0.03}) {
    ClockModel model;
    Device device(5);
    device.tick = 77;
    run(model, device, 0, 5);
    device.jump_s = jump_s;
    const Spread after = run(model, device, 5, 7);
    EXPECT_LT(after.largest_s, 5e-3) << jump_s;
    EXPECT_LE(after.doubtful, 40) << jump_s << " of 120";
    EXPECT_LT(run(model, device, 7, 12).largest_s, 0.2e-3) << jump_s;
    EXPECT_LE(model.jumps(), 1);
    if (jump_s < 0) {
      EXPECT_EQ(model.jumps(), 1) << jump_s;
    }
  }
}

/// The first datum after a step forward is late as a single datagram may be; from the second on it
/// shows that those after it are as late, and come at the tracker's pace.
TEST(ClockModel, RestartsWhenTheHostsClockJumps) {
  for (const bool counts : {false, true}) {
    for (const double jump_s : {-3.0, -0.2, 0.2, 3.0}) {
      ClockModel model;
      Device device(15);
      if (counts) device.tick = 77;
      run(model, device, 0, 5);
      // Seen from the host the device was set the other way; its counter shows nothing of that.
      for (int i = 0; i < 240; ++i) {
        device.jump_s = 0;
        device.start_of_day_s = 40000.0 - jump_s;
        const double error = device.error_at(model, 5 + jump_s + i / 60.0);
        if (!device.doubtful && i >= 1) {
          EXPECT_LT(std::abs(error), 5e-3) << jump_s << ' ' << i;
        }
      }
      EXPECT_EQ(model.jumps(), 1) << jump_s << ' ' << counts;
    }
  }
}

TEST(ClockModel, DuringAJumpNothingIsLaterThanItsArrival) {
  ClockModel model;
  Device device(6);
  run(model, device, 0, 5);
  device.jump_s = 3600;
  for (int i = 0; i < 10; ++i) EXPECT_LT(device.error_at(model, 5 + i / 60.0), 0.02);
}

TEST(ClockModel, LateDatagramsAreOnlyJitter) {
  ClockModel model;
  Device device(7);
  run(model, device, 0, 5);
  for (int i = 0; i < 300; ++i) {
    if (i % 20 < 3) device.extra_late_s = 0.2;
    EXPECT_LT(std::abs(device.error_at(model, 5 + i / 60.0)), 0.1e-3);
  }
  EXPECT_EQ(model.jumps(), 0);
}

TEST(ClockModel, WithACounterLateDatagramsAreNotEvenInDoubt) {
  ClockModel model;
  Device device(7);
  device.tick = 77;
  run(model, device, 0, 5);
  for (int i = 0; i < 300; ++i) {
    const int in_turn = i % 20;
    if (in_turn == 2) device.extra_late_s = 0.2;                                     // alone
    if (in_turn >= 10 && in_turn < 16) device.extra_late_s = (16 - in_turn) / 60.0;  // together
    EXPECT_LT(std::abs(device.error_at(model, 5 + i / 60.0)), 0.1e-3) << i;
    EXPECT_FALSE(device.doubtful) << i;
  }
  EXPECT_EQ(model.jumps(), 0);
}

TEST(ClockModel, AStalledNetworkIsNoJump) {
  ClockModel model;
  Device device(8);
  run(model, device, 0, 5);
  for (int i = 0; i < 60; ++i) {  // one second of datagrams, delivered all at once
    device.extra_late_s = 1.0 - i / 60.0;
    EXPECT_LT(std::abs(device.error_at(model, 5 + i / 60.0)), 0.1e-3) << i;
  }
  EXPECT_LT(run(model, device, 6, 10).largest_s, 0.1e-3);
  EXPECT_EQ(model.jumps(), 0);
}

TEST(ClockModel, IsCausal) {
  std::vector<double> first;
  for (const int length : {300, 600}) {
    ClockModel model;
    Device device(9);
    std::vector<double> errors;
    for (int i = 0; i < length; ++i) errors.push_back(device.error_at(model, i / 60.0));
    if (first.empty()) first = errors;
    for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(errors[i], first[i]);
  }
}

/// Neither too fast, for a delay of seconds is no new route, nor never.
TEST(ClockModel, FollowsANewRouteAsTheWindowForgets) {
  for (const double longer_s : {0.005, 0.010, -0.005}) {
    ClockModel model;
    Device device(10);
    device.tick = 5;
    run(model, device, 0, 30);
    std::vector<double> errors;
    for (int i = 0; i < 40 * 60; ++i) {
      device.extra_late_s = longer_s;
      errors.push_back(device.error_at(model, 30 + i / 60.0));
    }
    EXPECT_EQ(model.jumps(), 0);
    EXPECT_NEAR(errors[30 * 60], longer_s, 0.2e-3);
    if (longer_s < 0) {
      EXPECT_NEAR(errors[2 * 60], longer_s, 0.3e-3) << "proof that the way is shorter";
    } else {
      EXPECT_LT(errors[5 * 60], 0.5e-3) << longer_s;
    }
  }
}

TEST(ClockModel, AnswersNonsenseWithTheArrival) {
  ClockModel model;
  const auto nan = model.observe(std::numeric_limits<double>::quiet_NaN(), 17);
  EXPECT_EQ(nan.timestamp_ns, 17);
  EXPECT_TRUE(nan.doubtful);
  EXPECT_EQ(model.observe(100.0, 1'000'000'000).timestamp_ns, 1'000'000'000);
  const auto infinite = model.observe(std::numeric_limits<double>::infinity(), 1'016'000'000);
  EXPECT_EQ(infinite.timestamp_ns, 1'016'000'000);
  EXPECT_NEAR(static_cast<double>(model.observe(100.02, 1'020'000'000).timestamp_ns), 1.02e9, 1.0);
}

TEST(ClockModel, ReportsWhatItKnows) {
  ClockModel model;
  EXPECT_EQ(model.report().state, ClockState::kAbsent);
  Device device(11);
  device.drift = 40e-6;
  device.tick = 0;
  device.start_of_day_s = kDay_s - 15;
  run(model, device, 0, 1);
  EXPECT_EQ(model.report().state, ClockState::kSettling);
  EXPECT_EQ(model.report().drift_ppm, 0) << "does not show yet";
  run(model, device, 1, 30);
  const ClockReport steady = model.report();
  EXPECT_EQ(steady.state, ClockState::kSteady);
  EXPECT_NEAR(steady.drift_ppm, 40, 10);
  EXPECT_NEAR(steady.jitter_ms, 3.0, 0.7) << "95 % of an exponential's mean of 1 ms";
  EXPECT_NEAR(steady.span_s, 30, 0.1);
  EXPECT_EQ(steady.jumps, 0);
  EXPECT_EQ(steady.midnights, 1);
  device.jump_s = 5;
  run(model, device, 30, 31);
  EXPECT_EQ(model.report().state, ClockState::kSettling);
  run(model, device, 31, 34);
  EXPECT_EQ(model.report().state, ClockState::kSteady);
  device.jump_s = 15;
  run(model, device, 34, 38);
  EXPECT_EQ(model.report().state, ClockState::kUnstable) << "twice within seconds";
  EXPECT_EQ(model.report().jumps, 2);
  run(model, device, 38, 100);
  EXPECT_EQ(model.report().state, ClockState::kSteady);
}

}  // namespace
}  // namespace handeye
