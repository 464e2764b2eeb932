// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/methods/signed_quaternions.hpp"

#include "daemon/handeye/linear_parts.hpp"

namespace handeye {

SignedQuaternions signed_quaternions(const Movement& movement, const Eigen::Quaterniond& about) {
  SignedQuaternions signed_pair{Eigen::Quaterniond(movement.hand_j_from_hand_i.linear()),
                                Eigen::Quaterniond(movement.eye_j_from_eye_i.linear())};
  auto& [hand, eye] = signed_pair;
  if (eye.dot(about * hand * about.conjugate()) < 0) eye.coeffs() = -eye.coeffs();
  return signed_pair;
}

Eigen::Matrix4d rotation_rows(const SignedQuaternions& quaternions) {
  return left_product(quaternions.eye) - right_product(quaternions.hand);
}

Eigen::Quaterniond dual_part(const Eigen::Quaterniond& q, const Eigen::Vector3d& t) {
  Eigen::Quaterniond dual = Eigen::Quaterniond(0, t.x(), t.y(), t.z()) * q;
  dual.coeffs() *= 0.5;
  return dual;
}

}  // namespace handeye
