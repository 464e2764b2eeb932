// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

namespace handeye {

struct ClockModelOptions {
  double window_s{20.0};          ///< arrivals older than this are forgotten
  double max_drift{200e-6};       ///< s per s; crystals are within 100 ppm of each other
  double jump_s{0.050};           ///< a step of (arrival - device) beyond this restarts the window
  int jump_confirmations{5};      ///< so many in a row, for a single late datagram is only jitter
};

/// Maps a device clock to the host's CLOCK_MONOTONIC (math.md section 9): the lower envelope of
/// (arrival - device time) over a sliding window, with drift. Arrivals are late by a constant plus a
/// jitter that is never negative, so the envelope is the mapping plus the constant latency; that
/// constant is part of the time offset which is estimated apart.
///
/// Device time is seconds of the day and falls back to 0 at midnight (a fall of more than half a day
/// while arrivals advance); a jump of either clock restarts the window. Constant time and no
/// allocation per observation once the window is full.
class ClockModel {
 public:
  explicit ClockModel(const ClockModelOptions& options = {});

  /// Takes one pair of stamps, in order of arrival, and returns the host time [ns] of the
  /// measurement. Causal: depends on what has been observed so far only.
  std::int64_t observe(double device_s, std::int64_t arrival_ns);

  /// Restarts of the window because a clock jumped.
  int restarts() const { return restarts_; }

  /// Rate of the device clock against the host's, minus 1.
  double drift() const { return drift_; }

 private:
  int restarts_{0};
  double drift_{0};
};

}  // namespace handeye
