// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/pose_residual.hpp"

#include <cmath>

namespace handeye {
namespace {

Eigen::Quaterniond rotation_by(const Eigen::Vector3d& w) {
  const double half_angle = 0.5 * w.norm();
  const double half_sinc = half_angle < 1e-4 ? 0.5 * (1.0 - half_angle * half_angle / 6.0)
                                             : 0.5 * std::sin(half_angle) / half_angle;
  Eigen::Quaterniond rotation;
  rotation.w() = std::cos(half_angle);
  rotation.vec() = half_sinc * w;
  return rotation;
}

Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& q) {
  const double sine = q.vec().norm();
  const double cosine = std::abs(q.w());
  const double factor = sine < 1e-10 ? 2.0 : 2.0 * std::atan2(sine, cosine) / sine;
  return std::copysign(factor, q.w()) * q.vec();
}

/// d w of w = Log(Exp(d) Exp(w)) is this times d; its transpose that of Log(Exp(w) Exp(d)).
Eigen::Matrix3d inverse_left_jacobian(const Eigen::Vector3d& w) {
  const double square = w.squaredNorm();
  double factor = 1.0 / 12.0;
  if (square > 1e-8) {
    const double angle = std::sqrt(square);
    factor = (1.0 - 0.5 * angle / std::tan(0.5 * angle)) / square;
  }
  const Eigen::Matrix3d cross = skew(w);
  return Eigen::Matrix3d::Identity() - 0.5 * cross + factor * cross * cross;
}

/// What value and Jacobian have in common.
struct Geometry {
  Eigen::Matrix3d hand_from_room;
  Eigen::Vector3d eye_from_centre_mm;  ///< of the scene, in the room's directions
  Vector6d residual;

  Geometry(const CentredPose& pose, const PoseUnknowns& unknowns) {
    // A larger offset means that the hand was measured earlier: step back along its motion.
    const Eigen::Quaterniond hand =
        pose.room_from_hand * rotation_by(-unknowns.time_offset_s * pose.angular_velocity);
    const Eigen::Vector3d hand_in_room =
        pose.hand_in_room_mm - unknowns.time_offset_s * pose.velocity;
    hand_from_room = hand.conjugate().toRotationMatrix();
    eye_from_centre_mm =
        unknowns.room_from_scene * (pose.eye_in_scene_mm * std::exp(-unknowns.log_scale));
    residual << rotation_vector(hand.conjugate() * unknowns.room_from_scene * pose.scene_from_eye *
                                unknowns.hand_from_eye.conjugate()),
        hand_from_room * (eye_from_centre_mm + unknowns.scene_in_room_mm - hand_in_room) -
            unknowns.eye_in_hand_mm;
  }
};

}  // namespace

PoseUnknowns PoseUnknowns::moved_by(const UnknownsVector& step) const {
  PoseUnknowns moved = *this;
  moved.hand_from_eye = (rotation_by(step.segment<3>(kEyeTurn)) * hand_from_eye).normalized();
  moved.eye_in_hand_mm += step.segment<3>(kEyeShift);
  moved.room_from_scene = (rotation_by(step.segment<3>(kSceneTurn)) * room_from_scene).normalized();
  moved.scene_in_room_mm += step.segment<3>(kSceneShift);
  moved.log_scale += step[kLogScale];
  moved.time_offset_s += step[kTimeOffset];
  return moved;
}

Vector6d pose_residual(const CentredPose& pose, const PoseUnknowns& unknowns) {
  return Geometry(pose, unknowns).residual;
}

PoseResidual pose_residual_with_jacobian(const CentredPose& pose, const PoseUnknowns& unknowns) {
  const Geometry geometry(pose, unknowns);
  const Eigen::Matrix3d& hand_from_room = geometry.hand_from_room;
  const Eigen::Vector3d& omega = pose.angular_velocity;
  PoseResidual result;
  result.value = geometry.residual;
  result.jacobian.setZero();
  auto rotation = result.jacobian.topRows<3>();
  auto position = result.jacobian.bottomRows<3>();

  const Eigen::Matrix3d left = inverse_left_jacobian(result.value.head<3>());
  rotation.middleCols<3>(kEyeTurn) = -left.transpose();
  rotation.middleCols<3>(kSceneTurn) = left * hand_from_room;
  rotation.col(kTimeOffset) = left * omega;

  position.middleCols<3>(kEyeShift) = -Eigen::Matrix3d::Identity();
  position.middleCols<3>(kSceneTurn) = -hand_from_room * skew(geometry.eye_from_centre_mm);
  position.middleCols<3>(kSceneShift) = hand_from_room;
  position.col(kLogScale) = -hand_from_room * geometry.eye_from_centre_mm;
  const Eigen::Vector3d eye_in_hand_mm =
      result.value.tail<3>() + Eigen::Vector3d(unknowns.eye_in_hand_mm);
  position.col(kTimeOffset) = omega.cross(eye_in_hand_mm) + hand_from_room * pose.velocity;
  return result;
}

}  // namespace handeye
