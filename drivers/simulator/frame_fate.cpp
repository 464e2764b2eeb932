// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/frame_fate.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "drivers/simulator/mixed_bits.hpp"

namespace handeye::simulator {
namespace {

/// Stretches come again after so long. The picture freezes in the first half, the light fails in
/// the second.
constexpr double kPeriod_s = 10.0;
constexpr double kFreezes_s = 2.5;
constexpr double kDarkens_s = 5.0;

/// Of the gaps, so many are two frames long.
constexpr double kDoubleGaps = 0.25;

/// Distinguish the drawings.
constexpr std::uint64_t kBegins = 0x6d697373;
constexpr std::uint64_t kLasts = 0x74776963;

/// Probability p that a gap begins which loses the wanted share of frames: a frame arrives when no
/// gap begins at it and none of two frames began before it, 1 - share = (1 - p) (1 - p q).
double gap_probability(double share) {
  const double sum = 1.0 + kDoubleGaps;
  return (sum - std::sqrt(sum * sum - 4.0 * kDoubleGaps * share)) / (2.0 * kDoubleGaps);
}

/// When the stretch began that a time lies in.
std::optional<double> stretch_begin(double time_s, double begin_s, double length_s) {
  if (length_s <= 0) return std::nullopt;
  const double begin = begin_s + kPeriod_s * std::floor((time_s - begin_s) / kPeriod_s);
  if (begin < 0 || time_s >= begin + length_s) return std::nullopt;
  return begin;
}

}  // namespace

FrameFates::FrameFates(const Disturbances& disturbances, std::uint64_t seed, double camera_rate_hz)
    : disturbances_(disturbances),
      seed_(seed),
      camera_rate_hz_(camera_rate_hz),
      gap_probability_(gap_probability(disturbances.missing_share)) {}

FrameFate FrameFates::of(std::uint32_t number) const {
  const double time_s = number / camera_rate_hz_;
  FrameFate fate;
  fate.missing = is_missing(number);
  fate.dark = stretch_begin(time_s, kDarkens_s, disturbances_.dark_s).has_value();
  const auto frozen_since_s = stretch_begin(time_s, kFreezes_s, disturbances_.frozen_s);
  fate.shown = frozen_since_s ? std::min(number, static_cast<std::uint32_t>(
                                                     std::ceil(*frozen_since_s * camera_rate_hz_)))
                              : number;
  return fate;
}

bool FrameFates::is_missing(std::uint32_t number) const {
  if (gap_probability_ <= 0) return false;
  const auto begins_at = [this](std::uint32_t frame) {
    return mixed_fraction(seed_ ^ kBegins, frame) < gap_probability_;
  };
  return begins_at(number) || (number > 0 && begins_at(number - 1) &&
                               mixed_fraction(seed_ ^ kLasts, number - 1) < kDoubleGaps);
}

}  // namespace handeye::simulator
