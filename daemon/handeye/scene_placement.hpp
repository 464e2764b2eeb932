// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "daemon/handeye/pose_residual.hpp"

namespace handeye {

/// Sets room_from_scene of `unknowns` to the median, component by component, of what every pose
/// says with the hand_from_eye that they hold: many may be wrong, and by metres.
void place_scene(std::span<const CentredPose> poses, PoseUnknowns& unknowns);

}  // namespace handeye
