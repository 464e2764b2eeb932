// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/sync/frame_clock.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>

#include <gtest/gtest.h>

namespace handeye {
namespace {

constexpr std::int64_t kBoot_ns = 9'000'000'000'000;
constexpr std::int64_t kPeriod_ns = 40'000'000;
constexpr std::int64_t kWay_ns = 12'000'000;

/// A camera whose frames take at least kWay_ns to arrive, and some of them much longer.
class SimulatedCamera {
 public:
  explicit SimulatedCamera(std::uint32_t seed) : random_(seed) {}

  std::int64_t base_ns{0};  ///< of its clock against the host's
  double drift{0};
  double unpunctual_s{0};  ///< standard deviation of its stamps, arrivals with them
  std::uint32_t sequence{4'294'967'200U};
  bool counts{true};
  std::int64_t taken_ns{kBoot_ns};  ///< of the last frame, truly
  std::int64_t stamp_ns{0};
  std::int64_t longer_ns{0};  ///< all frames, from now on

  FrameTime next(FrameClock& clock) {
    taken_ns += kPeriod_ns;
    if (counts) ++sequence;
    const double late = unpunctual_s * normal_(random_);
    const double passed_ns = static_cast<double>(taken_ns - kBoot_ns);
    stamp_ns = kBoot_ns + base_ns + std::llround((1 + drift) * passed_ns + 1e9 * late);
    const auto jitter_ns = std::llround(2e6 * exponential_(random_) + 1e9 * std::max(0.0, late));
    return clock.observe(stamp_ns, taken_ns + kWay_ns + longer_ns + jitter_ns, sequence);
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  std::exponential_distribution<double> exponential_{1.0};
};

TEST(FrameClock, PassesStampsOfTheHostsOwnClockUnchanged) {
  FrameClock clock;
  SimulatedCamera camera(1);
  for (int i = 0; i < 3000; ++i) {
    camera.longer_ns = i % 50 < 10 ? 150'000'000 : 0;  // a busy machine
    if (i > 2000) camera.longer_ns = 300'000'000;      // and a slower way, for good
    const FrameTime time = camera.next(clock);
    ASSERT_FALSE(time.doubtful) << i;
    ASSERT_EQ(time.timestamp_ns, camera.stamp_ns);
  }
  EXPECT_EQ(clock.report().jumps, 0);
  EXPECT_EQ(clock.report().state, ClockState::kSteady);
}

TEST(FrameClock, BearsUnpunctualStampsAndCountsThatDoNotCount) {
  for (const bool counts : {true, false}) {
    FrameClock clock;
    SimulatedCamera camera(2);
    camera.unpunctual_s = 0.008;
    camera.counts = counts;
    int doubtful = 0;
    for (int i = 0; i < 2000; ++i) {
      camera.longer_ns = i % 100 < 5 ? 30'000'000 : 0;
      doubtful += camera.next(clock).doubtful ? 1 : 0;
    }
    EXPECT_EQ(clock.report().jumps, 0);
    EXPECT_LE(doubtful, 10) << "of 2000";
  }
}

TEST(FrameClock, PutsASteppedClockRight) {
  for (const std::int64_t step_ms : {-5000, -200, -60, 60, 200, 5000}) {
    FrameClock clock;
    SimulatedCamera camera(3);
    int doubtful = 0;
    std::int64_t last_ns = 0;
    for (int i = 0; i < 1000; ++i) {
      if (i == 500) camera.base_ns = step_ms * 1'000'000;
      const FrameTime time = camera.next(clock);
      if (time.doubtful) {
        ++doubtful;
        continue;
      }
      EXPECT_GT(time.timestamp_ns, last_ns);
      last_ns = time.timestamp_ns;
      EXPECT_NEAR(static_cast<double>(time.timestamp_ns - camera.taken_ns), 0, i < 500 ? 1 : 3e6)
          << step_ms << " ms, frame " << i;
    }
    EXPECT_EQ(clock.report().jumps, 1) << step_ms;
    EXPECT_LE(doubtful, 25) << step_ms;
    EXPECT_GE(doubtful, 5) << step_ms;
  }
}

TEST(FrameClock, TakesNoShortDelayForAStepWhereTheCameraDoesNotCount) {
  FrameClock clock;
  SimulatedCamera camera(6);
  camera.counts = false;
  for (int i = 0; i < 400; ++i) {
    const bool is_late = i >= 200 && i < 210;
    camera.longer_ns = is_late ? 200'000'000 : 0;
    const FrameTime time = camera.next(clock);
    if (is_late) continue;
    ASSERT_FALSE(time.doubtful) << i;
    ASSERT_EQ(time.timestamp_ns, camera.stamp_ns) << i;
  }
  EXPECT_EQ(clock.report().jumps, 0);
}

TEST(FrameClock, PutsASteppedClockRightWhereTheCameraDoesNotCount) {
  for (const std::int64_t step_ms : {-5000, -200, 200, 5000}) {
    FrameClock clock;
    SimulatedCamera camera(7);
    camera.counts = false;
    int doubtful = 0;
    for (int i = 0; i < 600; ++i) {
      if (i == 300) camera.base_ns = step_ms * 1'000'000;
      const FrameTime time = camera.next(clock);
      doubtful += time.doubtful ? 1 : 0;
      if (time.doubtful || i < 300) continue;
      ASSERT_NEAR(static_cast<double>(time.timestamp_ns - camera.taken_ns), 0, 4e6)
          << step_ms << " ms, frame " << i;
    }
    EXPECT_EQ(clock.report().jumps, 1) << step_ms;
    EXPECT_LE(doubtful, step_ms < 0 ? 80 : 25) << step_ms;
  }
}

// Age of the log when it is played; 3 s: its stamps may be the host's own, the first time.
TEST(FrameClock, FollowsALogThatIsPlayedAgainAndAgain) {
  for (const bool counts : {true, false}) {
    for (const std::int64_t age_s : {3, 1000}) {
      FrameClock clock;
      std::mt19937 random(8);
      std::exponential_distribution<double> jitter_s(1 / 0.001);
      std::int64_t now_ns = kBoot_ns;
      std::int64_t last_ns = 0;
      for (int pass = 0; pass < 4; ++pass) {
        int doubtful = 0;
        std::optional<double> way_ns;
        for (std::uint32_t i = 0; i < 250; ++i) {
          now_ns += kPeriod_ns;
          const std::int64_t stamp_ns = kBoot_ns - age_s * 1'000'000'000 + i * kPeriod_ns;
          const std::int64_t arrival_ns = now_ns + kWay_ns + std::llround(1e9 * jitter_s(random));
          const FrameTime time = clock.observe(stamp_ns, arrival_ns, counts ? 77 + i : 77);
          if (time.doubtful) {
            ++doubtful;
            continue;
          }
          EXPECT_GT(time.timestamp_ns, last_ns);
          last_ns = time.timestamp_ns;
          const auto this_way_ns = static_cast<double>(now_ns - time.timestamp_ns);
          if (!way_ns) way_ns = this_way_ns;
          ASSERT_NEAR(this_way_ns, *way_ns, 15e6)
              << age_s << " s old, pass " << pass << ", frame " << i;
        }
        EXPECT_LE(doubtful, counts ? 10 : 75) << age_s << " s old, pass " << pass;
      }
      EXPECT_EQ(clock.report().jumps, 3) << age_s << " s old";
    }
  }
}

TEST(FrameClock, MapsTheClockOfAnotherHost) {
  for (const double drift : {-60e-6, 60e-6}) {
    FrameClock clock;
    SimulatedCamera camera(4);
    camera.base_ns = -8'123'456'789'012;
    camera.drift = drift;
    for (int i = 0; i < 5000; ++i) {
      const FrameTime time = camera.next(clock);
      if (i < 100) continue;
      ASSERT_FALSE(time.doubtful) << i;
      const auto error_ns = static_cast<double>(time.timestamp_ns - camera.taken_ns - kWay_ns);
      ASSERT_NEAR(error_ns, 0, 1e6) << "the way is part of the time offset; frame " << i;
    }
    EXPECT_NEAR(clock.report().drift_ppm, 1e6 * drift, 15);
  }
}

TEST(FrameClock, StampsThatAreArrivalsAreNoClock) {
  FrameClock clock;
  std::int64_t now_ns = kBoot_ns;
  for (std::uint32_t i = 0; i < 100; ++i) {
    now_ns += kPeriod_ns + (i % 7) * 1'000'000;
    const FrameTime time = clock.observe(now_ns - 5'000'000, now_ns, i);
    EXPECT_EQ(time.timestamp_ns, now_ns - 5'000'000);
    EXPECT_FALSE(time.doubtful) << i;
  }
  EXPECT_EQ(clock.report().state, ClockState::kAbsent);
}

TEST(FrameClock, HandsNoFrameOnThatGoesBack) {
  FrameClock clock;
  for (std::uint32_t i = 0; i < 60; ++i) {
    const std::int64_t wrong_ns = i == 50 ? 45'000'000 : 0;
    const std::int64_t taken_ns = kBoot_ns + i * kPeriod_ns;
    const FrameTime time = clock.observe(taken_ns - wrong_ns, taken_ns + kWay_ns, i);
    EXPECT_EQ(time.doubtful, i == 50) << i;
  }
  EXPECT_EQ(clock.report().jumps, 0);
}

TEST(FrameClock, StampsThatKeepGoingBackAreThoseOfAnotherClock) {
  FrameClock clock;
  int handed_on = 0;
  for (std::uint32_t i = 0; i < 200; ++i) {
    // The first one is a second ahead, within what a stamp of the host's may be.
    const std::int64_t wrong_ns = i == 0 ? 900'000'000 : 0;
    const std::int64_t taken_ns = kBoot_ns + i * kPeriod_ns;
    const FrameTime time = clock.observe(taken_ns + wrong_ns, taken_ns + kWay_ns, i);
    if (i >= 50 && !time.doubtful) ++handed_on;
  }
  EXPECT_GE(handed_on, 145);
}

TEST(FrameClock, ACameraThatIsOpenedAnewBeginsAnew) {
  FrameClock clock;
  SimulatedCamera camera(5);
  for (int i = 0; i < 100; ++i) camera.next(clock);
  clock.restart();
  camera.sequence = 0;
  camera.taken_ns += 3'000'000'000;
  for (int i = 0; i < 100; ++i) {
    const FrameTime time = camera.next(clock);
    EXPECT_FALSE(time.doubtful) << i;
    EXPECT_EQ(time.timestamp_ns, camera.stamp_ns);
  }
  EXPECT_EQ(clock.report().jumps, 0);
}

}  // namespace
}  // namespace handeye
