// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dtrack/arrival_clock.hpp"

#include <algorithm>
#include <limits>

namespace handeye::dtrack {

std::int64_t clock_ns(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

void ArrivalClock::sample() {
  constexpr int kTries = 3;
  std::int64_t tightest_ns = std::numeric_limits<std::int64_t>::max();
  for (int attempt = 0; attempt < kTries; ++attempt) {
    const std::int64_t before_ns = clock_ns(CLOCK_MONOTONIC);
    const std::int64_t realtime_ns = clock_ns(CLOCK_REALTIME);
    now_ns_ = clock_ns(CLOCK_MONOTONIC);
    if (now_ns_ - before_ns >= tightest_ns) continue;
    tightest_ns = now_ns_ - before_ns;
    realtime_minus_monotonic_ns_ = realtime_ns - (before_ns + tightest_ns / 2);
  }
}

std::int64_t ArrivalClock::to_monotonic(std::int64_t realtime_ns) {
  // Not std::clamp: if `now` lay before the previous arrival its bounds would be crossed.
  const std::int64_t arrival_ns = realtime_ns - realtime_minus_monotonic_ns_;
  previous_arrival_ns_ = std::min(std::max(arrival_ns, previous_arrival_ns_), now_ns_);
  return previous_arrival_ns_;
}

}  // namespace handeye::dtrack
