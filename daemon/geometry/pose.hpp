// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

namespace handeye {

/// A rigid transformation, named a_from_b: maps coordinates in frame b to frame a.
/// Chains read left to right: a_from_c = a_from_b * b_from_c. Translation in mm unless named
/// otherwise.
using Pose = Eigen::Isometry3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

inline constexpr double kPi = 3.14159265358979323846;
constexpr double deg_from_rad(double angle_rad) {
  return angle_rad * (180.0 / kPi);
}
constexpr double rad_from_deg(double angle_deg) {
  return angle_deg * (kPi / 180.0);
}

/// Builds a pose; the quaternion (any norm but 0) is normalised.
Pose make_pose(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation);

/// Matrix of the cross product: skew(a) * b = a x b.
Eigen::Matrix3d skew(const Eigen::Vector3d& a);

/// Rotation by |w| [rad] about w (Rodrigues); exact at and near zero.
Eigen::Matrix3d exp_so3(const Eigen::Vector3d& w);

/// Inverse of exp_so3, |w| in [0, pi]; at pi the sign of the axis is arbitrary.
Eigen::Vector3d log_so3(const Eigen::Matrix3d& rotation);

/// Angle of a rotation [rad], in [0, pi]; accurate at both ends.
double rotation_angle_rad(const Eigen::Matrix3d& rotation);

/// Angle between two rotations [rad], in [0, pi].
double rotation_angle_rad(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b);

/// The rotation nearest to a matrix in the Frobenius norm (det = +1).
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix);

/// Between a (fraction 0) and b (fraction 1): constant angular speed about one axis, straight line
/// of the origin. Fractions outside 0..1 extrapolate.
Pose interpolate(const Pose& a, const Pose& b, double fraction);

}  // namespace handeye
