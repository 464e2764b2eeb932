// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/geometry/pose.hpp"

#include <cmath>

#include <Eigen/SVD>

namespace handeye {

Pose make_pose(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation) {
  Pose pose = Pose::Identity();
  pose.linear() = rotation.normalized().toRotationMatrix();
  pose.translation() = translation;
  return pose;
}

Eigen::Matrix3d skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d matrix;
  matrix << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return matrix;
}

Eigen::Matrix3d exp_so3(const Eigen::Vector3d& w) {
  const double half_angle = 0.5 * w.norm();
  // sin(x)/x by its series where the quotient loses digits.
  const double half_sinc = half_angle < 1e-4 ? 0.5 * (1.0 - half_angle * half_angle / 6.0)
                                             : 0.5 * std::sin(half_angle) / half_angle;
  Eigen::Quaterniond rotation;
  rotation.w() = std::cos(half_angle);
  rotation.vec() = half_sinc * w;
  return rotation.normalized().toRotationMatrix();
}

Eigen::Vector3d log_so3(const Eigen::Matrix3d& rotation) {
  Eigen::Quaterniond q(rotation);
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  if (sine < 1e-8) return 2.0 * q.vec();
  return 2.0 * std::atan2(sine, q.w()) / sine * q.vec();
}

double rotation_angle_rad(const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond q(rotation);
  return 2.0 * std::atan2(q.vec().norm(), std::abs(q.w()));
}

double rotation_angle_rad(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return rotation_angle_rad(a.transpose() * b);
}

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  signs.z() = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1.0 : 1.0;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

Pose interpolate(const Pose& a, const Pose& b, double fraction) {
  Pose between = Pose::Identity();
  between.linear() = a.linear() * exp_so3(fraction * log_so3(a.linear().transpose() * b.linear()));
  between.translation() = a.translation() + fraction * (b.translation() - a.translation());
  return between;
}

}  // namespace handeye
