// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "daemon/geometry/pose.hpp"
#include "daemon/reconstruction/frame_history.hpp"
#include "daemon/reconstruction/scene.hpp"

namespace handeye {

/// A pose after a neighbour of it was corrected, `old_from_new` = old eye_from_scene^-1 * new. Its
/// rotation is normalised: chains of corrections must not let rounding grow.
Pose carried(const Pose& eye_from_scene, const Pose& old_from_new);

/// After an adjustment of keyframes whose poses were `before`: frames between keyframes go along
/// with the keyframe before them, and so do the newest keyframes that took no part in it.
void carry_along(const std::vector<Pose>& before, Scene& scene, FrameHistory& frames);

}  // namespace handeye
