// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "daemon/handeye/types.hpp"

namespace handeye {

/// Movements in units in which translations are about 1, so that no solver depends on the caller's
/// units (docs/math.md section 2): with unknown scale each side has rms 1 of its own, with known
/// scale one unit serves both.
struct NormalisedMovements {
  std::vector<Movement> movements;
  double hand_mm{1};    ///< one normalised unit of the hand
  double eye_units{1};  ///< one normalised unit of the eye, in scene units

  /// The solution of the normalised movements in the caller's units. Its hand_from_eye is given as
  /// eye_from_hand with the translation in normalised hand units.
  HandEyeSolution restore(const Pose& eye_from_hand, double normalised_scale) const;
};

/// Nothing when the movements cannot determine hand-eye whatever the method: fewer than two,
/// numbers that are not finite, matrices that are not rotations, one side that never rotates or
/// whose axes are all parallel, or, with unknown scale, one that never translates.
std::optional<NormalisedMovements> normalise(std::span<const Movement> movements,
                                             ScaleMode scale = ScaleMode::kUnknown);

}  // namespace handeye
