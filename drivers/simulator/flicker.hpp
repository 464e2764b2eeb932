// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "drivers/simulator/sensor.hpp"

namespace handeye::simulator {

/// Brightness that never rests: automatic exposure that hunts, a slow beat of the lamp with the
/// camera's clock, black level included. Smooth; from one end to the other within a second. Drawn
/// from the seed.
class Flicker {
 public:
  /// `largest_change`: of mid-grey levels, 0 (none) to below 1.
  Flicker(double largest_change, std::uint64_t seed);

  /// Factor on mid-grey levels, 1 +- largest_change.
  double grey_gain(double time_s) const;

  Exposure exposure(double time_s) const;

 private:
  double wave(double time_s) const;

  double largest_change_;
  double hunting_phase_rad_, beat_phase_rad_, offset_phase_rad_;
};

}  // namespace handeye::simulator
