// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "daemon/handeye/types.hpp"

namespace handeye {

/// Movements in units in which both sides' translations have rms 1, so that no solver depends on
/// the units of the scene (math.md section 2).
struct NormalisedMovements {
  std::vector<Movement> movements;
  double hand_mm{1};    ///< one normalised unit of the hand
  double eye_units{1};  ///< one normalised unit of the eye, in scene units

  /// The solution of the normalised movements in the caller's units. Its hand_from_eye is given as
  /// eye_from_hand with the translation in normalised hand units.
  HandEyeSolution restore(const Pose& eye_from_hand, double normalised_scale) const;
};

/// Nothing when the movements cannot determine hand-eye and scale whatever the method: fewer than
/// two, numbers that are not finite, no rotation, all axes parallel, or one side never translates.
std::optional<NormalisedMovements> normalise(std::span<const Movement> movements);

}  // namespace handeye
