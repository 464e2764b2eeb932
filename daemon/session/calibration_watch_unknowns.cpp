// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/calibration_watch_unknowns.hpp"

#include <Eigen/Dense>

namespace handeye {

Pose put_eye(const WatchFrame& frame, const WatchUnknowns& at) {
  const double late_s = at.time_offset_correction_s;
  Pose hand = Pose::Identity();
  hand.linear() = exp_so3(-late_s * frame.angular_velocity) * frame.room_from_hand.linear();
  hand.translation() = frame.room_from_hand.translation() - late_s * frame.velocity;
  return hand * at.hand_from_eye;
}

WatchHandResidual watch_hand_residual(const WatchFrame& frame, const Pose& room_from_eye,
                                      const WatchUnknowns& at) {
  const Pose put = put_eye(frame, at);
  const Eigen::Matrix3d hand = put.linear() * at.hand_from_eye.linear().transpose();
  const Eigen::Vector3d lever = hand * at.hand_from_eye.translation();
  WatchHandResidual found;
  found.residual << log_so3(room_from_eye.linear() * put.linear().transpose()),
      room_from_eye.translation() - put.translation();
  found.by_common.topLeftCorner<3, 3>() = hand;
  found.by_common.block<3, 3>(3, 3) = hand;
  found.by_common.col(6) << -frame.angular_velocity,
      -frame.velocity - frame.angular_velocity.cross(lever);
  Matrix6d by_hand = Matrix6d::Identity();
  by_hand.bottomLeftCorner<3, 3>() = -skew(lever);
  found.information = (by_hand * frame.hand_covariance * by_hand.transpose()).inverse();
  return found;
}

void carry_eyes(std::span<const WatchFrame> frames, const WatchUnknowns& common,
                const Eigen::VectorXd& farther, WatchUnknowns& unknowns) {
  for (std::size_t k = 0; k < frames.size(); ++k) {
    Pose& eye = unknowns.room_from_eye[k];
    const Vector6d off = watch_hand_residual(frames[k], eye, unknowns).residual +
                         farther.segment<6>(static_cast<Eigen::Index>(6 * k));
    eye = put_eye(frames[k], common);
    eye.linear() = nearest_rotation(exp_so3(off.head<3>()) * eye.linear());
    eye.translation() += off.tail<3>();
  }
  unknowns.hand_from_eye = common.hand_from_eye;
  unknowns.time_offset_correction_s = common.time_offset_correction_s;
  for (WatchTrack& track : unknowns.tracks) {
    track.room_from_anchor = unknowns.room_from_eye[static_cast<std::size_t>(track.anchor)];
  }
}

}  // namespace handeye
