// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "daemon/geometry/pose.hpp"

/// Hand-eye calibration. Frames: room (the tracker's world), hand (the tracked body), eye (camera),
/// scene (the reconstruction's world). The seed's X = T_HE = eye_from_hand; users get
/// hand_from_eye.
namespace handeye {

/// Hand and eye at one instant.
struct PosePair {
  Pose room_from_hand{Pose::Identity()};  ///< mm
  Pose eye_from_scene{Pose::Identity()};  ///< scene units
};

/// Relative movement between two instants i and j (math.md, notation).
struct Movement {
  Pose hand_j_from_hand_i{Pose::Identity()};  ///< H; mm
  Pose eye_j_from_eye_i{Pose::Identity()};    ///< E; scene units
};

/// Movement between two pose pairs.
Movement movement_between(const PosePair& i, const PosePair& j);

struct HandEyeSolution {
  Pose hand_from_eye{Pose::Identity()};  ///< mm
  double scale_units_per_mm{1.0};        ///< s: scene units per mm
};

/// A method that solves from movements; nothing when the data do not determine the answer.
using MovementSolver = std::optional<HandEyeSolution> (*)(std::span<const Movement> movements);

struct Method {
  std::string_view name;
  MovementSolver solve;
  std::string_view source;  ///< paper and equation
};

/// Every method with unknown scale, in the order in which results list them.
std::span<const Method> unknown_scale_methods();

/// Standard deviations per axis, used as weights.
struct PoseNoise {
  double hand_rotation_rad{0.001};
  double hand_translation_mm{0.15};
  double eye_rotation_rad{0.0005};
  double eye_translation_mm{0.15};
};

/// The seed's residuals (section 5 of the paper): E against X H X^-1 in scene scale, means over
/// 1000 random pairs i != j, fixed generator.
struct Residuals {
  double rotation_deg{0};
  double rotation_percent{0};
  double translation_percent{0};
  double translation_norm_percent{0};
};
Residuals seed_residuals(std::span<const PosePair> poses, const HandEyeSolution& solution);

}  // namespace handeye
