// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "daemon/geometry/lens_parameters.hpp"
#include "daemon/handeye/one_step/one_step.hpp"
#include "tests/unit/handeye/one_step_tracks.hpp"

namespace handeye::synthetic {

/// A part's scene as the reconstruction might have chosen it.
struct SceneOfPart {
  Pose room_from_scene{Pose::Identity()};  ///< scene in mm
  double units_per_mm{1};
};

/// What a reconstruction makes of tracks: keyframes and points adjusted together, without knowledge
/// of where the room is, and the other frames resected at those points. The least-squares minimum,
/// found from the truth. `lens`: free in it, with this prior; nothing: the true lens.
/// The problem's frames have no hand yet.
OneStepProblem reconstruct(const Tracks& tracks, const std::vector<SceneOfPart>& scenes,
                           int keyframe_interval, const std::optional<LensPrior>& lens,
                           double noise_px);

}  // namespace handeye::synthetic
