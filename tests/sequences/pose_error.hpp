// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "daemon/geometry/pose.hpp"

namespace handeye::sequences {

/// A camera pose as it was and as a reconstruction has it, at one time stamp. The estimate's scene
/// frame and unit are its own.
struct PosePair {
  Pose true_scene_from_eye{Pose::Identity()};       ///< mm
  Pose estimated_scene_from_eye{Pose::Identity()};  ///< scene units
};

/// How far a reconstruction's camera poses are from the truth after the similarity that fits best.
struct PoseError {
  double rotation_rms_deg{0}, rotation_worst_deg{0};
  double position_rms{0}, position_worst{0};  ///< of the scene's distance
  double mm_per_unit{0};                      ///< the similarity's scale
  /// Rotation errors after the rotation that fits the orientations best instead of the positions:
  /// what is left of them where positions near one line leave the similarity uncertain.
  double turning_rms_deg{0}, turning_worst_deg{0};
};

/// Aligns the estimated eye positions with the true ones by the similarity of least squares
/// (Umeyama, PAMI 13(4), 1991, equations 39 to 42), turns the estimated orientations with it, and
/// takes the angles and distances that are left. Pairs of one part of a reconstruction. Nothing
/// when there are fewer than three or their positions are all on one line: then no similarity is
/// defined.
std::optional<PoseError> pose_error(std::span<const PosePair> pairs, double scene_distance_mm);

}  // namespace handeye::sequences
