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

/// Relative movement between two instants i and j (docs/math.md, notation).
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

/// Whether the eye's translations are in mm (a pattern) or in units of their own (a
/// reconstruction).
enum class ScaleMode { kKnown, kUnknown };

/// Standard deviations per axis, used as weights.
struct PoseNoise {
  double hand_rotation_rad{0.001};
  double hand_translation_mm{0.15};
  double eye_rotation_rad{0.0005};
  double eye_translation_mm{0.15};
};

/// What every method is given. Most use the movements, the likelihood the poses.
struct HandEyeProblem {
  std::span<const PosePair> poses;      ///< in order of time, without wrong ones (consensus.hpp)
  std::span<const Movement> movements;  ///< selected from them
  PoseNoise noise;                      ///< assumed; where it is estimated, the start
  bool estimate_noise{true};
};

/// Solves; nothing when the data do not determine the answer. With known scale the eye's
/// translations are in mm and the solution's scale is 1.
using Solver = std::optional<HandEyeSolution> (*)(const HandEyeProblem& problem);

/// Which equations a method solves, to first order: by them the noise of the poses passes into its
/// answer (sandwich.hpp). Those that say "then" solve in stages.
enum class ErrorModel {
  kNone,                   ///< not from movements, or not known
  kQuaternions,            ///< rotation by quaternions, then translation
  kGibbsVector,            ///< rotation by Tsai and Lenz, then translation
  kAxisFrames,             ///< rotation by Shiu and Ahmad, then translation
  kLogarithms,             ///< rotation by logarithms, then translation
  kEntries,                ///< rotation by its nine entries (with translation), then translation
  kScrews,                 ///< rotation by axes, then translation by the screws' moments
  kQuaternionsJoint,       ///< rotation and translation at once, quaternions and mm
  kDualQuaternions,        ///< at once, dual quaternions
  kScaleDualQuaternions,   ///< rotation, then scale, then dual quaternions
  kScaleQuaternionsJoint,  ///< rotation, then scale, then quaternions and mm at once
  kEquation7,              ///< scale by eq 7, then dual quaternions
  kEquation15,             ///< scale by eq 15, then dual quaternions
  kEntriesJoint,           ///< nine entries, translation and scale at once
};

struct Method {
  std::string_view name;  ///< as users know it; the same name may be in both tables
  Solver solve;
  std::string_view source;  ///< paper and equation
  ErrorModel error_model{ErrorModel::kNone};
};

/// Every method for this case, in the order in which results list them; the last one is the answer.
std::span<const Method> methods(ScaleMode scale);

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
