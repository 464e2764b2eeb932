// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/perspective/gibbs.hpp"

#include "daemon/geometry/pose.hpp"

namespace handeye {
namespace {

/// The half turn (or none) nearest to a rotation: the unit quaternion 1, i, j or k along its
/// largest component.
Eigen::Quaterniond nearest_base(const Eigen::Quaterniond& rotation) {
  Eigen::Index largest = 0;
  rotation.coeffs().cwiseAbs().maxCoeff(&largest);
  Eigen::Quaterniond base;
  base.coeffs() = Eigen::Vector4d::Unit(largest);
  return base;
}

}  // namespace

Eigen::Vector3d gibbs_from_rotation(const Eigen::Quaterniond& rotation) {
  return rotation.vec() / rotation.w();
}

Eigen::Quaterniond rotation_from_gibbs(const Eigen::Vector3d& gibbs) {
  return Eigen::Quaterniond(1.0, gibbs.x(), gibbs.y(), gibbs.z()).normalized();
}

BasedGibbs::BasedGibbs(const Eigen::Quaterniond& rotation)
    : base(nearest_base(rotation)), z(gibbs_from_rotation(rotation * base.conjugate())) {}

Eigen::Quaterniond BasedGibbs::rotation() const {
  return rotation_from_gibbs(z) * base;
}

Eigen::Matrix3d BasedGibbs::rotation_vector_by_z() const {
  return 2.0 / (1.0 + z.squaredNorm()) * (Eigen::Matrix3d::Identity() + skew(z));
}

}  // namespace handeye
