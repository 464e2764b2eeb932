// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/geometry/pose.hpp"
#include "drivers/simulator/motion.hpp"
#include "drivers/simulator/random_stream.hpp"

namespace handeye::simulator {

/// How well a tracker sees a body that its cameras look at from one side: worse along their line of
/// sight than across it, and worse at some times than at others, as markers come and go.
class SightNoise {
 public:
  /// `rotation_rad`, `translation_mm`: standard deviations per axis, in the mean.
  SightNoise(std::uint64_t seed, double rotation_rad, double translation_mm);

  /// Of (w [rad], dt [mm]) in the room: R = Exp(w) R_true, t = t_true + dt.
  Matrix6d covariance(double time_s) const;

  /// A measurement with an error drawn from covariance(time_s).
  Pose measure(const Pose& room_from_body, double time_s, RandomStream& random) const;

 private:
  double worse(double time_s) const;

  double rotation_rad_, translation_mm_;
  Wander visibility_;
  Eigen::Matrix3d room_from_sight_;  ///< its z: the line of sight
};

/// The same covariance in the tracker's own terms: of x, y, z [mm] and its Euler angles eta, theta,
/// phi [rad], R = Rx(eta) Ry(theta) Rz(phi). Not where theta is +-90 deg.
Matrix6d euler_covariance(const Matrix6d& room_covariance, const Eigen::Vector3d& euler_angles_rad);

}  // namespace handeye::simulator
