// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "daemon/handeye/pose_residual.hpp"
#include "daemon/handeye/types.hpp"

namespace handeye {

/// Sets room_from_scene of `unknowns` to the median, component by component, of what every pose
/// says with the hand_from_eye that they hold: many may be wrong, and by metres.
void place_scene(std::span<const CentredPose> poses, PoseUnknowns& unknowns);

/// Scene units per mm: how long the eye's path is in the scene against the one that hand and
/// hand_from_eye of `start` say, by the median over pairs. The start's where there is no path.
double scale_of_path(std::span<const PosePair> poses, const HandEyeSolution& start);

}  // namespace handeye
