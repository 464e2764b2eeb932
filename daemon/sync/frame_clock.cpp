// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/sync/frame_clock.hpp"

#include <algorithm>
#include <cstdlib>

namespace handeye {
namespace {

// A driver that hands out arrivals for stamps does so to the nanosecond, or less half an exposure.
constexpr std::int64_t kSameWay_ns = 1'000;
constexpr std::int64_t kFramesToTell = 30;
// Drivers that stamp in software are that unpunctual.
constexpr double kStep_s = 0.030;
// A frame that others overtook is late by no more than that.
constexpr std::int32_t kReordered = 8;
// Single stamps go back by mistake; so many in a row are those of another clock.
constexpr int kBackwardsInARow = 10;

ClockModelOptions options_for_frames() {
  ClockModelOptions options;
  options.lenient = true;
  options.step_s = kStep_s;
  return options;
}

}  // namespace

FrameClock::FrameClock() : model_(options_for_frames()) {}

FrameTime FrameClock::observe(std::int64_t stamp_ns, std::int64_t arrival_ns,
                              std::uint32_t sequence) {
  if (is_played_again(stamp_ns, sequence)) begin_anew();
  FrameTime time = time_of(stamp_ns, arrival_ns, sequence);
  if (time.doubtful) return time;
  if (newest_ns_ != 0 && time.timestamp_ns <= newest_ns_) {
    ++backwards_;
    time.doubtful = true;
    if (++backwards_in_a_row_ == kBackwardsInARow) begin_anew();
    return time;
  }
  backwards_in_a_row_ = 0;
  newest_ns_ = time.timestamp_ns;
  return time;
}

/// Stamps and count go back together: a log begins again, or the sender did with its host. Neither
/// contradicts the other, so the clock model would take it for a delay.
bool FrameClock::is_played_again(std::int64_t stamp_ns, std::uint32_t sequence) const {
  const auto counted = static_cast<std::int32_t>(sequence - last_sequence_);
  return frames_ > 0 && counted < -kReordered && stamp_ns < last_stamp_ns_;
}

void FrameClock::begin_anew() {
  restart();
  ++jumps_before_;
}

FrameTime FrameClock::time_of(std::int64_t stamp_ns, std::int64_t arrival_ns,
                              std::uint32_t sequence) {
  const std::int64_t way_ns = arrival_ns - stamp_ns;
  if (base_ == Base::kUnknown) {
    // The host's clock does not go back either.
    const bool is_hosts = way_ns <= kOldest_ns && way_ns >= -kLatest_ns && stamp_ns > newest_ns_;
    base_ = is_hosts ? Base::kHost : Base::kForeign;
    first_stamp_ns_ = stamp_ns;
  }
  ++frames_;
  last_stamp_ns_ = stamp_ns;
  last_sequence_ = sequence;
  constant_ways_ += std::abs(way_ns - last_way_ns_) < kSameWay_ns ? 1 : 0;
  last_way_ns_ = way_ns;
  const ClockReading reading =
      model_.observe(1e-9 * static_cast<double>(stamp_ns - first_stamp_ns_), arrival_ns, sequence);
  if (base_ == Base::kHost) return pass(stamp_ns, arrival_ns, reading);
  return {reading.timestamp_ns - shortest_way_ns_.value_or(0), reading.doubtful};
}

/// A stamp of the host's own clock is doubtful only while that clock itself may have been stepped.
FrameTime FrameClock::pass(std::int64_t stamp_ns, std::int64_t arrival_ns,
                           const ClockReading& reading) {
  if (model_.epoch() > 0) {
    base_ = Base::kCorrected;
    return {reading.timestamp_ns - shortest_way_ns_.value_or(0), true};
  }
  if (reading.contradicts) return {stamp_ns, true};
  const std::int64_t way_ns = arrival_ns - stamp_ns;
  shortest_way_ns_ = std::min(shortest_way_ns_.value_or(way_ns), way_ns);
  return {stamp_ns, false};
}

void FrameClock::restart() {
  jumps_before_ += model_.jumps();
  model_ = ClockModel(options_for_frames());
  base_ = Base::kUnknown;
  shortest_way_ns_.reset();
  frames_ = constant_ways_ = 0;
  backwards_in_a_row_ = 0;
}

ClockReport FrameClock::report() const {
  ClockReport report = model_.report();
  report.jumps += jumps_before_;
  report.midnights = 0;
  report.backwards = backwards_;
  const bool is_arrival = frames_ >= kFramesToTell && constant_ways_ + 1 >= frames_;
  if (is_arrival) report.state = ClockState::kAbsent;
  return report;
}

}  // namespace handeye
