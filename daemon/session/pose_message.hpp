// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/geometry/pose.hpp"

namespace handeye {

/// A pose as all messages carry it: unit quaternion, w first and never negative, and translation
/// [mm].
inline void write_pose(const Pose& pose, double (&q_wxyz)[4], double (&t_mm)[3]) {
  Eigen::Quaterniond q(pose.linear());
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  q_wxyz[0] = q.w();
  q_wxyz[1] = q.x();
  q_wxyz[2] = q.y();
  q_wxyz[3] = q.z();
  for (int axis = 0; axis < 3; ++axis) t_mm[axis] = pose.translation()(axis);
}

/// The inverse.
inline Pose read_pose(const double (&q_wxyz)[4], const double (&t_mm)[3]) {
  return make_pose({q_wxyz[0], q_wxyz[1], q_wxyz[2], q_wxyz[3]},
                   Eigen::Map<const Eigen::Vector3d>(t_mm));
}

}  // namespace handeye
