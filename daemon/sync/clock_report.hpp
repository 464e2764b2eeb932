// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace handeye {

enum class ClockState : std::uint8_t {
  kAbsent,    ///< the device sends no time; arrivals, or the host's own stamps, stand for it
  kSettling,  ///< the mapping is too young to trust
  kSteady,
  kUnstable,  ///< the clock has jumped again and again, or is in doubt just now
};

/// What is known of a device's clock against the host's (clock_status_t).
struct ClockReport {
  ClockState state{ClockState::kAbsent};
  double drift_ppm{0};  ///< how much faster the device's clock runs; 0 until it shows
  double jitter_ms{0};  ///< how much later than the earliest its data arrive: 95 % of the last ones
  double span_s{0};     ///< how long the mapping has held
  std::int64_t jumps{0};
  std::int64_t midnights{0};  ///< times that the time of day fell back to 0
  std::int64_t backwards{0};  ///< cameras: frames whose stamp was not after the one before
};

/// Quantile of the last few hundred values, without allocation. Adding is cheap, asking is not.
class RecentQuantile {
 public:
  void add(double value);
  /// `share` 0..1; 0 when there are no values.
  double at(double share) const;
  void clear() { count_ = 0; }

 private:
  static constexpr std::size_t kValues = 256;  // 4 s at 60 Hz
  std::array<float, kValues> values_{};
  std::size_t count_{0};  ///< of all that were added
};

}  // namespace handeye
