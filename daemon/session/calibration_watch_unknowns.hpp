// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "daemon/session/calibration_watch_frame.hpp"

namespace handeye {

/// What is adjusted: hand_from_eye, the time offset's correction, where the eye was at each frame,
/// and the points.
struct WatchUnknowns {
  Pose start{Pose::Identity()};  ///< hand_from_eye, that it is held near
  Pose hand_from_eye{Pose::Identity()};
  double time_offset_correction_s{0};
  std::vector<Pose> room_from_eye;
  std::vector<WatchTrack> tracks;
};

/// Unknowns that all frames share: w [rad] and dt [mm] of hand_from_eye, the time offset [s].
inline constexpr int kWatchCommon = 7;

/// How far the eye of a frame is from where hand and hand_from_eye put it: (w [rad], dc [mm]) in
/// the room; and what it means.
struct WatchHandResidual {
  Vector6d residual{Vector6d::Zero()};
  Matrix6d information{Matrix6d::Zero()};  ///< inverse covariance, from the hand's noise
  Eigen::Matrix<double, 6, kWatchCommon> by_common{
      Eigen::Matrix<double, 6, kWatchCommon>::Zero()};  ///< of where the eye is put
};
WatchHandResidual watch_hand_residual(const WatchFrame& frame, const Pose& room_from_eye,
                                      const WatchUnknowns& at);

/// Where hand and common unknowns put the eye of a frame.
Pose put_eye(const WatchFrame& frame, const WatchUnknowns& at);

/// Goes over to the common unknowns of `common`: the eyes stay as far from where they are put as
/// they were, and go `farther` by six of each; the points go with them.
void carry_eyes(std::span<const WatchFrame> frames, const WatchUnknowns& common,
                const Eigen::VectorXd& farther, WatchUnknowns& unknowns);

}  // namespace handeye
