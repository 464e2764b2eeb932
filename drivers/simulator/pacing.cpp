// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/pacing.hpp"

#include <algorithm>
#include <time.h>

#include "protocol/bus.hpp"

namespace handeye::simulator {

bool sleep_until(std::int64_t wake_ns, const std::stop_token& stop) {
  constexpr std::int64_t kLongestNapNs = 20'000'000;
  constexpr std::int64_t kNsPerS = 1'000'000'000;
  while (!stop.stop_requested()) {
    const std::int64_t now_ns = monotonic_ns();
    if (now_ns >= wake_ns) return true;
    const std::int64_t nap_end_ns = std::min(wake_ns, now_ns + kLongestNapNs);
    const timespec nap_end{nap_end_ns / kNsPerS, nap_end_ns % kNsPerS};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &nap_end, nullptr);
  }
  return false;
}

}  // namespace handeye::simulator
