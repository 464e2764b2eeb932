// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "daemon/handeye/maximum_likelihood.hpp"

namespace handeye {

/// The least-squares problem of `maximum_likelihood` for a given noise: residuals, minimiser,
/// Jacobian. Scene in mm by the start's scale, room and scene counted from the mean of their poses,
/// which keeps the normal equations well conditioned whatever the origins.
class PoseProblem {
 public:
  PoseProblem(std::span<const HandEyeObservation> observations, const HandEyeSolution& start,
              const MaximumLikelihoodOptions& options);

  /// Minimises the whitened residuals with Huber's loss (Ceres, one thread).
  void solve(const Matrix6d& whitening);

  /// Residual per pose, not whitened: rotation [rad] and position of the camera [mm], hand frame.
  std::vector<Vector6d> residuals() const;

  /// Of the whitened residuals, without the loss. Columns: w and dt of hand_from_eye, w and dt of
  /// room_from_scene, then log scale and time offset, those that are estimated.
  Eigen::MatrixXd jacobian(const Matrix6d& whitening) const;

  Eigen::Index parameters() const;
  HandEyeSolution solution() const;
  Pose room_from_scene() const;  ///< scene in mm
  double time_offset_correction_s() const { return time_offset_s_; }

 private:
  struct CentredPose {
    Eigen::Quaterniond room_from_hand;
    Eigen::Vector3d hand_in_room_mm;
    Eigen::Quaterniond scene_from_eye;
    Eigen::Vector3d eye_in_scene_mm;
    Eigen::Vector3d angular_velocity;
    Eigen::Vector3d velocity;
  };
  struct Residual;

  MaximumLikelihoodOptions options_;
  std::vector<CentredPose> poses_;
  double start_scale_{1};
  Eigen::Vector3d room_centre_mm_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d scene_centre_mm_{Eigen::Vector3d::Zero()};

  Eigen::Quaterniond hand_from_eye_;
  Eigen::Vector3d eye_in_hand_mm_;
  Eigen::Quaterniond room_from_scene_;
  Eigen::Vector3d scene_in_room_mm_;
  double log_scale_{0};  ///< against the start's scale
  double time_offset_s_{0};
};

}  // namespace handeye
