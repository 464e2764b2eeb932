// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "daemon/geometry/pose.hpp"

/// One pose's equation of `maximum_likelihood`, and its derivatives.
namespace handeye {

/// Steps of the unknowns, in this order: rotation [rad] and translation [mm] of hand_from_eye,
/// those of room_from_scene, log scale, time offset [s].
inline constexpr int kUnknowns = 14;
inline constexpr int kEyeTurn = 0;
inline constexpr int kEyeShift = 3;
inline constexpr int kSceneTurn = 6;
inline constexpr int kSceneShift = 9;
inline constexpr int kLogScale = 12;
inline constexpr int kTimeOffset = 13;
using UnknownsVector = Eigen::Matrix<double, kUnknowns, 1>;
using UnknownsMatrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;

struct PoseUnknowns {
  Eigen::Quaterniond hand_from_eye{Eigen::Quaterniond::Identity()};
  Eigen::Vector3d eye_in_hand_mm{Eigen::Vector3d::Zero()};
  Eigen::Quaterniond room_from_scene{Eigen::Quaterniond::Identity()};
  Eigen::Vector3d scene_in_room_mm{Eigen::Vector3d::Zero()};
  double log_scale{0};      ///< of scene units per mm, against the scale the scene was divided by
  double time_offset_s{0};  ///< a larger one means that the hand was measured earlier

  /// Rotations are turned from the left: R -> Exp(w) R.
  PoseUnknowns moved_by(const UnknownsVector& step) const;
};

/// Hand and eye at one instant; room and scene counted from any fixed point.
struct CentredPose {
  Eigen::Quaterniond room_from_hand;
  Eigen::Vector3d hand_in_room_mm;
  Eigen::Quaterniond scene_from_eye;
  Eigen::Vector3d eye_in_scene_mm;
  Eigen::Vector3d angular_velocity;  ///< in the hand frame [rad/s]
  Eigen::Vector3d velocity;          ///< in the room [mm/s]
};

/// Camera against tracker, in the hand frame: rotation [rad], then position of the camera [mm].
struct PoseResidual {
  Vector6d value;
  Eigen::Matrix<double, 6, kUnknowns> jacobian;
};

Vector6d pose_residual(const CentredPose& pose, const PoseUnknowns& unknowns);
PoseResidual pose_residual_with_jacobian(const CentredPose& pose, const PoseUnknowns& unknowns);

}  // namespace handeye
