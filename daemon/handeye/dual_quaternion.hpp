// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "daemon/handeye/types.hpp"

namespace handeye {

/// X of E X = X H with both translations in the same unit (Daniilidis 1999, "Hand-eye calibration
/// using dual quaternions", eqs 31-36): rotation and translation at once from the singular vectors
/// of the stacked 6n x 8 matrix, dual rows weighted by `translation_weights`. Translations should
/// be about 1. `about`: a rotation near R_X, which settles the signs of the quaternions near 180
/// degrees and is where the weights start. Returns eye_from_hand, or nothing when the motion does
/// not determine it.
std::optional<Pose> eye_from_hand_by_dual_quaternions(std::span<const Movement> movements,
                                                      const Eigen::Matrix3d& about);

}  // namespace handeye
