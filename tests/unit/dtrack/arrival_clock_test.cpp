// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dtrack/arrival_clock.hpp"

#include <gtest/gtest.h>

namespace handeye::dtrack {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

TEST(DTrackArrivalClock, ConvertsByTheDifferenceOfTheClocks) {
  ArrivalClock clock;
  const std::int64_t stamp_realtime_ns = clock_ns(CLOCK_REALTIME);
  const std::int64_t stamp_monotonic_ns = clock_ns(CLOCK_MONOTONIC);
  clock.sample();
  EXPECT_NEAR(static_cast<double>(clock.to_monotonic(stamp_realtime_ns) - stamp_monotonic_ns), 0.0,
              0.02 * kSecond);
}

TEST(DTrackArrivalClock, NeverInTheFutureAndNeverBackwards) {
  ArrivalClock clock;
  clock.sample();
  const std::int64_t realtime_ns = clock_ns(CLOCK_REALTIME);
  EXPECT_EQ(clock.to_monotonic(realtime_ns + 3600 * kSecond), clock.now_ns());
  const std::int64_t first_ns = clock.now_ns();
  EXPECT_EQ(clock.to_monotonic(realtime_ns - 3600 * kSecond), first_ns);
}

}  // namespace
}  // namespace handeye::dtrack
