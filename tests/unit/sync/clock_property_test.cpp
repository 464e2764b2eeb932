// SPDX-License-Identifier: BSD-3-Clause
// The clock model against simulated truth: hours of drift, and whatever a network and an operator
// do.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/sync/clock_model.hpp"

namespace handeye {
namespace {

constexpr double kDay_s = 86400.0;
constexpr double kRate_hz = 60;
constexpr double kLatency_s = 0.007;
constexpr std::int64_t kBoot_ns = 3'000'000'000'000;

struct Sent {
  double measured_s{0};  ///< true time, by the host's clock
  double noise_s{0};     ///< of the device's own stamp
  double device_s{0};
  double arrival_s{0};
  std::uint32_t tick{0};
  bool after_jump{false};
};

struct Network {
  double drift{0};
  double jitter_s{0.001};        ///< mean, exponential
  double jitter_on_device_s{0};  ///< standard deviation of the device's own stamps
  double lost{0};
  double overtaken{0};  ///< share of datagrams that come 1 to 3 periods late
  std::optional<double> hold_at_s, hold_for_s;  ///< nothing arrives meanwhile, then all at once
  std::optional<double> jump_at_s;
  double jump_s{0};
  double start_of_day_s{50'000};
};

std::vector<Sent> simulate(const Network& network, double length_s, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::exponential_distribution<double> late(1.0);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<Sent> sent;
  for (int i = 0; i < static_cast<int>(length_s * kRate_hz); ++i) {
    Sent datagram;
    datagram.measured_s = i / kRate_hz;
    datagram.after_jump = network.jump_at_s && datagram.measured_s >= *network.jump_at_s;
    datagram.noise_s = network.jitter_on_device_s * normal(random);
    const double device_s = network.start_of_day_s + (1 + network.drift) * datagram.measured_s +
                            (datagram.after_jump ? network.jump_s : 0) + datagram.noise_s;
    datagram.device_s = std::fmod(device_s + kDay_s, kDay_s);
    datagram.tick = 4'294'967'000U + static_cast<std::uint32_t>(i);
    double arrival_s = datagram.measured_s + kLatency_s + network.jitter_s * late(random);
    if (share(random) < network.overtaken) arrival_s += (1 + 2 * share(random)) / kRate_hz;
    if (network.hold_at_s && arrival_s >= *network.hold_at_s) {
      arrival_s = std::max(arrival_s, *network.hold_at_s + *network.hold_for_s + 1e-6 * i);
    }
    datagram.arrival_s = arrival_s;
    if (share(random) >= network.lost) sent.push_back(datagram);
  }
  std::ranges::stable_sort(sent, {}, &Sent::arrival_s);
  return sent;
}

struct Outcome {
  /// Error of the mapping where it is not doubtful, the constant latency taken off.
  double worst_s{0};
  double worst_at_s{0};
  int doubtful{0};
  int longest_doubt{0};  ///< in a row
  ClockReport report;
};

Outcome run(const std::vector<Sent>& sent, bool counts, double from_s = 0) {
  ClockModel model;
  Outcome outcome;
  int doubt = 0;
  for (const Sent& datagram : sent) {
    const ClockReading reading =
        model.observe(datagram.device_s, kBoot_ns + std::llround(datagram.arrival_s * 1e9),
                      counts ? std::optional(datagram.tick) : std::nullopt);
    if (datagram.measured_s < from_s) continue;
    doubt = reading.doubtful ? doubt + 1 : 0;
    outcome.doubtful += reading.doubtful ? 1 : 0;
    outcome.longest_doubt = std::max(outcome.longest_doubt, doubt);
    if (reading.doubtful) continue;
    const double error_s = 1e-9 * static_cast<double>(reading.timestamp_ns - kBoot_ns) -
                           datagram.measured_s - kLatency_s - datagram.noise_s;
    if (std::abs(error_s) > std::abs(outcome.worst_s)) {
      outcome.worst_s = error_s;
      outcome.worst_at_s = datagram.measured_s;
    }
  }
  outcome.report = model.report();
  return outcome;
}

TEST(ClockProperties, HoursOfDriftStayBelowHalfAMillisecond) {
  for (const double drift : {-50e-6, 50e-6}) {
    for (const double on_device_s : {0.0, 0.00005}) {
      const Network network{.drift = drift,
                            .jitter_on_device_s = on_device_s,
                            .lost = 0.02,
                            .overtaken = 0.01,
                            .start_of_day_s = 80'000};
      const Outcome outcome = run(simulate(network, 3 * 3600.0, 1), true, 5);
      EXPECT_LT(std::abs(outcome.worst_s), 0.5e-3) << outcome.worst_at_s;
      EXPECT_EQ(outcome.doubtful, 0);
      EXPECT_EQ(outcome.report.jumps, 0);
      EXPECT_EQ(outcome.report.midnights, 1);
      EXPECT_EQ(outcome.report.state, ClockState::kSteady);
      EXPECT_NEAR(outcome.report.drift_ppm, 1e6 * drift, 10);
    }
  }
}

/// A tracker's own stamps are noisy, too, which makes data come early as well as late; a full
/// window is not dragged down by the earliest.
TEST(ClockProperties, HoursOfNoisyStampsStayBelowAMillisecond) {
  for (const double drift : {-50e-6, 50e-6}) {
    const Network network{
        .drift = drift, .jitter_on_device_s = 0.0003, .lost = 0.02, .overtaken = 0.01};
    for (const bool counts : {false, true}) {
      const Outcome outcome = run(simulate(network, 3 * 3600.0, 1), counts, 20);
      EXPECT_LT(std::abs(outcome.worst_s), 1e-3) << outcome.worst_at_s;
      if (counts) {
        EXPECT_EQ(outcome.doubtful, 0) << "without, what was overtaken by three is";
      }
      EXPECT_EQ(outcome.report.jumps, 0);
      EXPECT_NEAR(outcome.report.drift_ppm, 1e6 * drift, 20);
    }
  }
}

class ClockScenarios : public testing::TestWithParam<bool> {};

/// Whatever the step, wherever it falls: what is not marked is right within 5 ms, and after at most
/// 30 data in a row nothing is marked any more. Without a counter that holds from 50 ms on.
TEST_P(ClockScenarios, AJumpMarksWhatItMakesDoubtful) {
  const bool counts = GetParam();
  for (const double jump_s : {-3600.0, -5.0, -0.2, -0.1, -0.06, 0.06, 0.1, 0.2, 5.0, 3600.0}) {
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
      const Network network{.drift = 50e-6, .lost = 0.05, .jump_at_s = 12.0, .jump_s = jump_s};
      const Outcome outcome = run(simulate(network, 20, seed), counts);
      EXPECT_LT(std::abs(outcome.worst_s), 5e-3)
          << jump_s << " seed " << seed << " at " << outcome.worst_at_s;
      EXPECT_EQ(outcome.report.jumps, 1) << jump_s << " seed " << seed;
      EXPECT_LE(outcome.longest_doubt, 30) << jump_s << " seed " << seed;
    }
  }
}

TEST_P(ClockScenarios, ASwitchThatHoldsDatagramsBackIsNoJump) {
  const bool counts = GetParam();
  for (const double hold_s : {0.05, 0.2, 1.0}) {
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
      const Network network{.drift = -50e-6, .hold_at_s = 8.003, .hold_for_s = hold_s};
      const Outcome outcome = run(simulate(network, 20, seed), counts);
      EXPECT_LT(std::abs(outcome.worst_s), 5e-3)
          << hold_s << " seed " << seed << " at " << outcome.worst_at_s;
      EXPECT_EQ(outcome.report.jumps, 0) << hold_s;
      if (counts) {
        EXPECT_LE(outcome.longest_doubt, 4) << hold_s << ": the clock is not in doubt";
      }
    }
  }
}

TEST_P(ClockScenarios, AJumpWithinABurstIsFoundInTheEnd) {
  const bool counts = GetParam();
  for (const double jump_s : {-0.2, -0.1, -0.06, 0.06, 0.1, 0.2}) {
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
      const Network network{
          .hold_at_s = 8.003, .hold_for_s = 0.2, .jump_at_s = 8.1, .jump_s = jump_s};
      const Outcome outcome = run(simulate(network, 14, seed), counts);
      if (counts) {
        EXPECT_LT(std::abs(outcome.worst_s), 5e-3)
            << jump_s << " seed " << seed << " at " << outcome.worst_at_s;
        EXPECT_EQ(outcome.report.jumps, 1) << jump_s << " seed " << seed;
      }
      EXPECT_LE(outcome.report.jumps, 1) << jump_s << " seed " << seed;
      EXPECT_LE(outcome.longest_doubt, 40);
    }
  }
}

TEST_P(ClockScenarios, AStartWithinABurstIsMarked) {
  const bool counts = GetParam();
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    const Network network{.hold_at_s = 0.0, .hold_for_s = 0.2};
    const Outcome outcome = run(simulate(network, 10, seed), counts);
    EXPECT_LT(std::abs(outcome.worst_s), 5e-3) << seed << " at " << outcome.worst_at_s;
    EXPECT_LE(outcome.longest_doubt, 30);
    EXPECT_EQ(outcome.report.jumps, 0);
  }
}

TEST_P(ClockScenarios, MidnightPassesWhateverHappensAroundIt) {
  const bool counts = GetParam();
  for (const double midnight_s : {0.0, 0.016, 0.03, 5.0, 5.008}) {
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
      const Network network{.jitter_s = 0.004,
                            .jitter_on_device_s = 0.0003,
                            .lost = 0.05,
                            .overtaken = 0.3,
                            .start_of_day_s = kDay_s - midnight_s};
      const Outcome outcome = run(simulate(network, 10, seed), counts);
      EXPECT_EQ(outcome.report.jumps, 0) << midnight_s << " seed " << seed;
      EXPECT_LE(outcome.report.midnights, 1);
      EXPECT_LT(std::abs(outcome.worst_s), 8e-3) << midnight_s << " seed " << seed;
      EXPECT_LE(outcome.longest_doubt, 60);
      if (midnight_s > 1) {
        EXPECT_EQ(outcome.report.midnights, 1) << seed;
      }
    }
  }
}

TEST_P(ClockScenarios, ALongSilenceCostsAFewSamples) {
  const bool counts = GetParam();
  for (const double silence_s : {3.0, 15.0, 60.0, 7200.0}) {
    std::vector<Sent> sent = simulate({.drift = 50e-6}, silence_s + 20, 3);
    std::erase_if(sent, [&](const Sent& datagram) {
      return datagram.measured_s > 10 && datagram.measured_s < 10 + silence_s;
    });
    const Outcome outcome = run(sent, counts);
    EXPECT_LT(std::abs(outcome.worst_s), 5e-3) << silence_s << " at " << outcome.worst_at_s;
    EXPECT_LE(outcome.longest_doubt, 20) << silence_s;
    EXPECT_EQ(outcome.report.jumps, 0) << silence_s;
  }
}

/// Another controller sends from now on: its day time and its counter are its own.
TEST_P(ClockScenarios, AnotherControllerIsAJump) {
  for (const double apart_s : {-40'000.0, -2.0, 0.3, 7.0}) {
    std::vector<Sent> sent = simulate({}, 10, 4);
    for (Sent next : simulate({.start_of_day_s = 50'000 + 10 + apart_s}, 10, 5)) {
      next.measured_s += 10;
      next.arrival_s += 10;
      next.tick += 123'456'789U;
      sent.push_back(next);
    }
    const Outcome outcome = run(sent, GetParam());
    EXPECT_LT(std::abs(outcome.worst_s), 5e-3) << apart_s << " at " << outcome.worst_at_s;
    EXPECT_EQ(outcome.report.jumps, 1) << apart_s;
    EXPECT_LE(outcome.longest_doubt, 30);
  }
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutCounter, ClockScenarios, testing::Bool());

/// The controller's count begins anew, its clock goes on: three data are looked at twice.
TEST(ClockProperties, ACounterThatBeginsAnewIsNoJumpOfTheClock) {
  std::vector<Sent> sent = simulate({.drift = 20e-6}, 20, 6);
  for (Sent& datagram : sent) {
    if (datagram.measured_s >= 10)
      datagram.tick = static_cast<std::uint32_t>(std::lround(60 * (datagram.measured_s - 10)));
  }
  const Outcome outcome = run(sent, true, 5);
  EXPECT_EQ(outcome.report.jumps, 0);
  EXPECT_LE(outcome.doubtful, 4);
  EXPECT_LT(std::abs(outcome.worst_s), 0.5e-3);
}

/// Packets made from stills: the counter goes on where the clock leaps, and both are right.
TEST(ClockProperties, ACounterThatDoesNotFollowTheClockIsNotBelieved) {
  std::vector<Sent> sent;
  for (int still = 0; still < 8; ++still) {
    for (int i = 0; i < 20; ++i) {
      const double time_s = 2.0 * still + i / kRate_hz;
      sent.push_back({time_s, 0, 1000 + time_s, time_s + kLatency_s,
                      static_cast<std::uint32_t>(20 * still + i), false});
    }
  }
  const Outcome outcome = run(sent, true);
  EXPECT_EQ(outcome.report.jumps, 0);
  EXPECT_LE(outcome.longest_doubt, 3);
  EXPECT_LT(std::abs(outcome.worst_s), 1e-6);
}

}  // namespace
}  // namespace handeye
