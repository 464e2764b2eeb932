// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <ceres/manifold.h>

#include "daemon/geometry/pose.hpp"

namespace handeye {

/// A pose as Ceres holds it: quaternion x, y, z, w, then the translation.
using PoseParameters = std::array<double, 7>;

PoseParameters to_parameters(const Pose& pose);
Pose to_pose(const double* parameters);

/// Steps of a pose: rotation vector w with R <- Exp(w) R, and the translation's change. The cost
/// functions give their derivative by these six directly, in the first six columns of the pose's
/// block; the seventh is zero. PlusJacobian is the matching (I 0)^T, so that Ceres' product of both
/// is the derivative by the step, without the detour over four quaternion elements.
class PoseManifold final : public ceres::Manifold {
 public:
  /// `fixed_axis`: component of the translation that keeps its value (0 to 2), or -1: all free.
  explicit PoseManifold(int fixed_axis = -1) : fixed_axis_(fixed_axis) {}

  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return fixed_axis_ < 0 ? 6 : 5; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;

 private:
  int fixed_axis_;
};

}  // namespace handeye
