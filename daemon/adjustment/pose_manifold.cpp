// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/adjustment/pose_manifold.hpp"

namespace handeye {

PoseParameters to_parameters(const Pose& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const Eigen::Vector3d& t = pose.translation();
  return {q.x(), q.y(), q.z(), q.w(), t.x(), t.y(), t.z()};
}

Pose to_pose(const double* parameters) {
  return make_pose(Eigen::Quaterniond(Eigen::Map<const Eigen::Vector4d>(parameters)),
                   Eigen::Map<const Eigen::Vector3d>(parameters + 4));
}

bool PoseManifold::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  const Eigen::Quaterniond step(exp_so3(Eigen::Map<const Eigen::Vector3d>(delta)));
  const Eigen::Quaterniond rotation(Eigen::Map<const Eigen::Vector4d>{x});
  Eigen::Map<Eigen::Vector4d>{x_plus_delta} = (step * rotation).normalized().coeffs();
  int column = 3;
  for (int axis = 0; axis < 3; ++axis) {
    x_plus_delta[4 + axis] = x[4 + axis] + (axis == fixed_axis_ ? 0.0 : delta[column++]);
  }
  return true;
}

bool PoseManifold::PlusJacobian(const double* /*x*/, double* jacobian) const {
  Eigen::Map<Eigen::Matrix<double, 7, Eigen::Dynamic, Eigen::RowMajor>> map(jacobian, 7,
                                                                            TangentSize());
  map.setZero();
  int column = 0;
  for (int row = 0; row < 6; ++row) {
    if (row - 3 != fixed_axis_ || fixed_axis_ < 0) map(row, column++) = 1.0;
  }
  return true;
}

bool PoseManifold::Minus(const double* y, const double* x, double* y_minus_x) const {
  const Eigen::Quaterniond to(Eigen::Map<const Eigen::Vector4d>{y});
  const Eigen::Quaterniond from(Eigen::Map<const Eigen::Vector4d>{x});
  Eigen::Map<Eigen::Vector3d>{y_minus_x} = log_so3((to * from.conjugate()).toRotationMatrix());
  int column = 3;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis != fixed_axis_) y_minus_x[column++] = y[4 + axis] - x[4 + axis];
  }
  return true;
}

bool PoseManifold::MinusJacobian(const double* /*x*/, double* jacobian) const {
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 7, Eigen::RowMajor>> map(jacobian, TangentSize(),
                                                                            7);
  map.setZero();
  int row = 0;
  for (int column = 0; column < 6; ++column) {
    if (column - 3 != fixed_axis_ || fixed_axis_ < 0) map(row++, column) = 1.0;
  }
  return true;
}

}  // namespace handeye
