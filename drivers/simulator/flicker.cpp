// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/flicker.hpp"

#include <cmath>

#include "daemon/geometry/pose.hpp"
#include "drivers/simulator/random_stream.hpp"

namespace handeye::simulator {
namespace {

/// Half a period, the way from dark to bright, takes 0.6 s.
constexpr double kHuntingHz = 0.83;
constexpr double kBeatHz = 6.1;
constexpr double kBeatShare = 0.15;
constexpr double kOffsetHz = 0.37;

/// Black level at a change of 0.35; in proportion otherwise.
constexpr double kOffsetGrey = 4.0;

}  // namespace

Flicker::Flicker(double largest_change, std::uint64_t seed) : largest_change_(largest_change) {
  RandomStream random(seed, Purpose::kFlicker);
  hunting_phase_rad_ = random.uniform(0, 2 * kPi);
  beat_phase_rad_ = random.uniform(0, 2 * kPi);
  offset_phase_rad_ = random.uniform(0, 2 * kPi);
}

double Flicker::wave(double time_s) const {
  return (1 - kBeatShare) * std::sin(2 * kPi * kHuntingHz * time_s + hunting_phase_rad_) +
         kBeatShare * std::sin(2 * kPi * kBeatHz * time_s + beat_phase_rad_);
}

double Flicker::grey_gain(double time_s) const {
  return 1.0 + largest_change_ * wave(time_s);
}

Exposure Flicker::exposure(double time_s) const {
  if (largest_change_ <= 0) return {};
  const double offset_grey = kOffsetGrey * largest_change_ / 0.35 *
                             std::sin(2 * kPi * kOffsetHz * time_s + offset_phase_rad_);
  return {static_cast<float>(light_gain_of(grey_gain(time_s))), static_cast<float>(offset_grey)};
}

}  // namespace handeye::simulator
