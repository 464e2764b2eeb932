// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace handeye {

struct ClockModelOptions {
  double window_s{20.0};      ///< arrivals older than this are forgotten
  double max_drift{200e-6};   ///< s per s; crystals are within 100 ppm of each other
  double jump_s{0.050};       ///< a step of (arrival - device) beyond this restarts the window
  int jump_confirmations{5};  ///< so many in a row, for a single late datagram is only jitter
  double settling_s{0.1};  ///< the mapping follows a change of the envelope with this time constant
};

/// Maps a device clock to the host's CLOCK_MONOTONIC (docs/math.md section 9): the lower envelope
/// of (arrival - device time) over a sliding window, with drift. Arrivals are late by a constant
/// plus a jitter that is never negative, so the envelope is the mapping plus the constant latency;
/// that constant is part of the time offset which is estimated apart.
///
/// Device time is seconds of the day and falls back to 0 at midnight; a jump of either clock
/// restarts the window. Constant time and no allocation per observation.
///
/// The envelope is the line below all points that is nearest to them (the edge of the lower convex
/// hull below their mean), its slope within the drift limits. The hull needs only the lowest point
/// of each slice of the window, which is what is kept.
class ClockModel {
 public:
  explicit ClockModel(const ClockModelOptions& options = {});

  /// Takes one pair of stamps, in order of arrival, and returns the host time [ns] of the
  /// measurement. Causal: depends on what has been observed so far only. Stamps that contradict the
  /// mapping by more than a jump are not believed until they are confirmed; meanwhile the answer is
  /// the old mapping's, but never later than the arrival. A device time that is no finite number
  /// counts as such a stamp and is answered with its arrival.
  std::int64_t observe(double device_s, std::int64_t arrival_ns);

  /// Restarts of the window because a clock jumped.
  int restarts() const { return restarts_; }

  /// Rate of the device clock against the host's, minus 1. 0 until the window shows any.
  double drift() const { return -line_.slope; }

 private:
  /// One observation: device time and how much later the host's clock read when it arrived, both
  /// since the window's start.
  struct Point {
    double device_s{0};
    double lateness_s{0};
  };
  /// Lateness as a function of device time.
  struct Line {
    double device_s{0};
    double lateness_s{0};
    double slope{0};
    double at(double device) const { return lateness_s + slope * (device - device_s); }
  };
  /// A slice of the window: its lowest point and how many observations it saw.
  struct Slice {
    Point lowest;
    double observations{0};
  };
  static constexpr std::size_t kSlices = 80;

  double unwrapped(double device_s, std::int64_t arrival_ns) const;
  void start(double device_s, std::int64_t arrival_ns);
  bool confirms_jump(const Point& suspect);
  double believable_s(double device_s) const;
  bool insert(const Point& point);
  void fit();
  void settle(double device_s);

  ClockModelOptions options_;
  bool started_{false};
  std::int64_t origin_ns_{0};  ///< arrival of the first observation
  double origin_device_s_{0};  ///< its device time
  double last_device_s_{0};    ///< unwrapped, of the last believed observation
  std::int64_t last_arrival_ns_{0};

  std::array<Slice, kSlices> slices_{};  ///< ring of those that saw an observation, in order
  std::size_t first_{0};
  std::size_t count_{0};
  std::int64_t newest_slice_{0};

  Line line_;               ///< the envelope
  double correction_s_{0};  ///< what the mapping still lags behind the envelope
  double settled_at_s_{0};  ///< device time at which the correction was last shrunk

  Point first_suspect_;
  int suspects_{0};
  int restarts_{0};
};

}  // namespace handeye
