// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <ctime>

namespace handeye::dtrack {

std::int64_t clock_ns(clockid_t clock);

/// Turns the kernel's time stamps of received datagrams, which are CLOCK_REALTIME, into
/// CLOCK_MONOTONIC.
///
/// Both clocks are read at one instant (REALTIME between two readings of MONOTONIC, the tightest of
/// three tries), soon after the arrival, and arrival = monotonic - (realtime - stamp). The age of a
/// stamp is short, so slewing of REALTIME does not matter. Should REALTIME be stepped within it the
/// result is held between the previous arrival and now, for a socket's queue is in order and
/// nothing arrives in the future.
///
/// The kernel starts stamping some moments after the machine's first socket asks for it; datagrams
/// before that are stamped when they are fetched.
class ArrivalClock {
 public:
  /// Reads both clocks. Call it after the stamps were taken, before to_monotonic().
  void sample();

  /// CLOCK_MONOTONIC of the last sample(), ns.
  std::int64_t now_ns() const { return now_ns_; }

  /// Stamps in order of arrival; at most now_ns().
  std::int64_t to_monotonic(std::int64_t realtime_ns);

 private:
  std::int64_t now_ns_{0};
  std::int64_t realtime_minus_monotonic_ns_{0};
  std::int64_t previous_arrival_ns_{0};
};

}  // namespace handeye::dtrack
