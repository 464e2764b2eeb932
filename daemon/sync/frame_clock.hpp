// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "daemon/sync/clock_model.hpp"
#include "daemon/sync/clock_report.hpp"

namespace handeye {

/// When a frame was taken, by the host's clock.
struct FrameTime {
  std::int64_t timestamp_ns{0};
  /// Do not use the frame: nobody knows when it was taken, or it was taken before one that was
  /// handed on.
  bool doubtful{false};
};

/// Watches the clock of a camera's stamps, and takes its place where it is not the host's.
///
/// Drivers stamp with the host's CLOCK_MONOTONIC, and such stamps pass unchanged: a frame's way
/// through driver and network is far less regular than its stamp, so to map them would only add
/// noise. But a driver's clock may be stepped all the same. The step shows against the camera's own
/// count of frames, and is confirmed by the arrivals; frames are doubtful until then, after which
/// the stamps are mapped so that the way takes as long as it took before.
///
/// Where the first stamps are of no such clock, as those of a camera on another host are, all are
/// mapped by the clock model: the shortest way then counts as no time, and is found with the time
/// offset. A log that is played again begins anew, with its count. Where stamps are nothing but
/// arrivals they pass, and the clock is absent.
///
/// Causal, constant time, no allocation per frame.
class FrameClock {
 public:
  /// The first stamps must be so near to their arrival for a stamp of the host's own clock.
  static constexpr std::int64_t kOldest_ns = 10'000'000'000;
  static constexpr std::int64_t kLatest_ns = 1'000'000'000;

  FrameClock();

  /// `sequence`: the camera's own count; wraps; a gap is a drop.
  FrameTime observe(std::int64_t stamp_ns, std::int64_t arrival_ns, std::uint32_t sequence);

  /// The camera was opened anew: its count, and maybe its clock, begins anew.
  void restart();

  ClockReport report() const;

 private:
  enum class Base { kUnknown, kHost, kCorrected, kForeign };

  bool is_played_again(std::int64_t stamp_ns, std::uint32_t sequence) const;
  void begin_anew();
  FrameTime time_of(std::int64_t stamp_ns, std::int64_t arrival_ns, std::uint32_t sequence);
  FrameTime pass(std::int64_t stamp_ns, std::int64_t arrival_ns, const ClockReading& reading);

  ClockModel model_;
  Base base_{Base::kUnknown};
  std::int64_t first_stamp_ns_{0};
  std::int64_t newest_ns_{0};                    ///< of those that were handed on
  std::optional<std::int64_t> shortest_way_ns_;  ///< arrival - stamp, before any step
  std::int64_t constant_ways_{0};  ///< frames whose arrival - stamp was that of the one before
  std::int64_t last_way_ns_{0};
  std::int64_t frames_{0};
  std::int64_t last_stamp_ns_{0};
  std::uint32_t last_sequence_{0};
  std::int64_t backwards_{0};
  int backwards_in_a_row_{0};
  std::int64_t jumps_before_{0};
};

}  // namespace handeye
