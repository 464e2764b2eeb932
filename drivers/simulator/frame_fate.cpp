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

constexpr double kMeanGap = 1.0 + kDoubleGaps;

/// Distinguish the drawings.
constexpr std::uint64_t kBegins = 0x6d697373;
constexpr std::uint64_t kLasts = 0x74776963;

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
      frames_per_gap_(kMeanGap / disturbances.missing_share) {}

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
  if (disturbances_.missing_share <= 0) return false;
  // One gap in every so many frames, somewhere among them: short recordings, too, lose their share.
  const double stretch = std::floor(number / frames_per_gap_);
  const auto in_gap_of = [this, number](double gap) {
    if (gap < 0) return false;
    const auto index = static_cast<std::uint64_t>(gap);
    const double begin =
        std::floor(frames_per_gap_ * (gap + mixed_fraction(seed_ ^ kBegins, index)));
    const double length = mixed_fraction(seed_ ^ kLasts, index) < kDoubleGaps ? 2 : 1;
    return number >= begin && number < begin + length;
  };
  // The gap before may reach in here, and the next begin up to a frame early, rounded down.
  return in_gap_of(stretch - 1) || in_gap_of(stretch) || in_gap_of(stretch + 1);
}

}  // namespace handeye::simulator
