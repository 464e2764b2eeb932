// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

namespace handeye {

/// Gibbs vector axis * tan(angle / 2) of a rotation; infinite at half a turn.
Eigen::Vector3d gibbs_from_rotation(const Eigen::Quaterniond& rotation);

/// Inverse of gibbs_from_rotation, for finite vectors.
Eigen::Quaterniond rotation_from_gibbs(const Eigen::Vector3d& gibbs);

/// A rotation R(z) * base with a Gibbs vector z that never grows large: the base is the identity or
/// the half turn about x, y or z, whichever leaves |z| <= sqrt(3). So Gauss-Newton's steps in z
/// stay good near half a turn, where the plain Gibbs vector runs to infinity.
struct BasedGibbs {
  Eigen::Quaterniond base{Eigen::Quaterniond::Identity()};
  Eigen::Vector3d z{Eigen::Vector3d::Zero()};

  explicit BasedGibbs(const Eigen::Quaterniond& rotation);

  Eigen::Quaterniond rotation() const;

  /// Rotation vector w [rad], per change of z: R(z + dz) = Exp(w_by_z * dz) R(z) to first order.
  Eigen::Matrix3d rotation_vector_by_z() const;
};

}  // namespace handeye
