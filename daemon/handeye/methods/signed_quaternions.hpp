// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "daemon/handeye/types.hpp"

namespace handeye {

/// Unit quaternions of a movement's two rotations, with signs that go together.
struct SignedQuaternions {
  Eigen::Quaterniond hand;
  Eigen::Quaterniond eye;
};

/// `about`: near R_X. The eye's sign is the one nearer to R_X R_H R_X^T, which is right on both
/// sides of 180 degrees, where either quaternion may come with either sign.
SignedQuaternions signed_quaternions(const Movement& movement, const Eigen::Quaterniond& about);

/// q_E q - q q_H as a matrix on q, w first.
Eigen::Matrix4d rotation_rows(const SignedQuaternions& quaternions);

/// (1/2) Q(t) q, the dual part of a rigid motion (Schmidt 2005, eq 8).
Eigen::Quaterniond dual_part(const Eigen::Quaterniond& q, const Eigen::Vector3d& t);

}  // namespace handeye
