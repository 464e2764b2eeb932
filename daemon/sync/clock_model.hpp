// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "daemon/sync/clock_report.hpp"
#include "daemon/sync/lower_envelope.hpp"
#include "daemon/sync/tick_witness.hpp"

namespace handeye {

struct ClockModelOptions {
  double window_s{20.0};      ///< arrivals older than this are forgotten
  double max_drift{200e-6};   ///< s per s; crystals are within 100 ppm of each other
  double jump_s{0.050};       ///< a step of (arrival - device) beyond this restarts the window
  int jump_confirmations{5};  ///< so many in a row, for a single late datagram is only jitter
  /// So many where the device's counter says that its clock was not stepped: a network that delays
  /// all of a second's data alike is likelier than a jump of the host's clock.
  int delay_confirmations{60};
  /// How far the device's clock and its counter may part before the clock was stepped: trackers
  /// stamp within 0.5 ms (ART's own figure).
  double step_s{0.003};
  /// A camera's data are delayed more, and less evenly, than its clock is stepped: what either its
  /// counter or the arrival vouches for is no jump, however long it lasts. Without a counter that
  /// counts, data that are late may be a jump, and take as long to be taken for one as a delay.
  bool lenient{false};
  /// A mapping holds once so many data have come within so much of the earliest, ...
  int settling_data{3};
  double settling_spread_s{0.0015};
  double settling_at_most_s{2.0};  ///< ... or after so long.
  double gliding_s{0.1};  ///< the mapping follows a change of the envelope with this time constant
  double doubtful_s{0.001};  ///< while it lags behind by more than this, its answers are doubtful
};

/// The mapping as it was at one datum. Two of one run, a and b, are on one device clock: b's says
/// that a was measured at a.device_ns + b.lateness_ns + b.slope (a.device_ns - b.device_ns).
struct ClockMapping {
  std::int64_t device_ns{0};    ///< of this datum, by the device's clock, near the host's
  std::int64_t lateness_ns{0};  ///< of the line there; without the gliding of the stamps
  double slope{0};
  std::int32_t run{0};  ///< counts the beginnings of the model
};

struct ClockReading {
  std::int64_t timestamp_ns{0};  ///< of the measurement, host CLOCK_MONOTONIC
  /// Nobody vouches for the stamp: a clock may have jumped, or the mapping is only being found. It
  /// is never later than the arrival, and otherwise means nothing.
  bool doubtful{false};
  bool contradicts{false};  ///< doubtful, because a clock may have jumped or has just done so
  ClockMapping mapping{};   ///< of what is not doubtful
};

/// Maps a device clock to the host's CLOCK_MONOTONIC (docs/math.md section 9): the lower envelope
/// of (arrival - device time) over a sliding window, with drift. Arrivals are late by a constant
/// plus a jitter that is never negative, so the envelope is the mapping plus the constant latency;
/// that constant is part of the time offset which is estimated apart.
///
/// Device time is seconds of the day and falls back to 0 at midnight, or seconds of any other
/// epoch; a jump of either clock restarts the window. A stamp that is not doubtful is within 5 ms
/// of the mapping that holds then, and within 0.5 ms after some seconds (jitter up to 1 ms). A
/// jump is seen
///  - with a frame counter, from step_s on and at once;
///  - without, from jump_s on: a smaller step back cannot be told from a longer way, and is
///    followed as the window forgets; a smaller step forward is followed at once.
///
/// Causal, constant time, no allocation per observation.
class ClockModel {
 public:
  explicit ClockModel(const ClockModelOptions& options = {});

  /// Takes one pair of stamps, in order of arrival, and the device's own count (a tracker's fr, a
  /// camera's sequence) where there is one. Stamps that contradict the mapping are doubtful until
  /// that is explained, by a jump or by a delay; meanwhile the answer is the old mapping's, but
  /// never later than the arrival. A device time that is no finite number is answered with its
  /// arrival.
  ClockReading observe(double device_s, std::int64_t arrival_ns,
                       std::optional<std::uint32_t> tick = std::nullopt);

  /// Counts the jumps: readings of two epochs are not on one time line.
  std::int32_t epoch() const { return static_cast<std::int32_t>(jumps_); }
  std::int64_t jumps() const { return jumps_; }

  /// Rate of the device clock against the host's, minus 1. 0 until the window shows any.
  double drift() const { return -envelope_.slope(); }

  /// How late the earliest data are, against the device's own epoch [s]; changes with drift.
  double lateness_s() const;

  /// A few microseconds: not for every datum.
  ClockReport report() const;

 private:
  using Point = LowerEnvelope::Point;
  enum class Belief { kBelieved, kLate, kDoubted, kJumped };

  double unwrapped(double device_s, std::int64_t arrival_ns) const;
  void start(double device_s, std::int64_t arrival_ns);
  ClockReading jump(double device_s, std::int64_t arrival_ns);
  Belief judge(const Point& point, bool witnessed);
  Belief judge_step(const Point& point, double residual_s);
  bool runs_on(const Point& suspect);
  double believable_s(double device_s) const;
  void take(const Point& point);
  void settle(const Point& point);
  void glide(double device_s);
  void count_midnights(double days_passed_s);
  std::int64_t mapped_ns(double device_s) const;
  ClockMapping mapping_at(double device_s) const;

  ClockModelOptions options_;
  bool started_{false};
  std::int64_t origin_ns_{0};  ///< arrival of the first observation
  double origin_device_s_{0};  ///< its device time
  double last_device_s_{0};    ///< unwrapped, of the last believed observation
  std::int64_t last_arrival_ns_{0};

  LowerEnvelope envelope_;
  TickWitness witness_;
  RecentQuantile residuals_s_;
  double correction_s_{0};    ///< what the mapping still lags behind the envelope
  double corrected_at_s_{0};  ///< device time at which the correction was last shrunk

  bool settled_{false};
  Point earliest_;   ///< while settling
  Point last_near_;  ///< the last that came within the spread of it
  int near_earliest_{0};

  Point first_suspect_;
  int suspects_{0};  ///< in a row, as late as each other while both clocks run on

  std::int32_t runs_{0};
  std::int64_t jumps_{0};
  std::int64_t before_last_jump_ns_{std::numeric_limits<std::int64_t>::min() / 2};
  std::int64_t last_jump_ns_{std::numeric_limits<std::int64_t>::min() / 2};
  std::int64_t day_{0};
  std::int64_t midnights_{0};
};

}  // namespace handeye
