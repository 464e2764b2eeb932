// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "daemon/handeye/types.hpp"

/// Steps of the methods that find the scale first and the rest of hand-eye with it.
namespace handeye {

/// The movements with the eye's translations in mm, given its units per mm.
std::vector<Movement> metric_movements(std::span<const Movement> movements,
                                       double scale_units_per_mm);

/// Rotation and translation by Daniilidis' linear dual quaternions, as dq_scale_separate does, with
/// the scale given: what eqs 7 and 15 are finished with (docs/math.md section 4). `about`: near
/// R_X, the rotation of eye_from_hand.
std::optional<HandEyeSolution> finish_by_dual_quaternions(std::span<const Movement> movements,
                                                          double scale_units_per_mm,
                                                          const Eigen::Matrix3d& about);

}  // namespace handeye
