// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <ceres/sized_cost_function.h>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/geometry/lens_parameters.hpp"

namespace handeye {

/// Error of one observation [px] under a known lens; blocks: pose (7, see PoseManifold), point (3).
/// The derivative by the pose is that by PoseManifold's tangent, in the first six columns.
class ReprojectionCost final : public ceres::SizedCostFunction<2, 7, 3> {
 public:
  ReprojectionCost(const CameraModel& camera, const Eigen::Vector2d& pixel)
      : camera_(camera), pixel_(pixel) {}

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  const CameraModel& camera_;
  Eigen::Vector2d pixel_;
};

/// The same with the lens free; blocks: pose (7), point (3), LensVector. `camera`: the rest of the
/// model.
class LensReprojectionCost final : public ceres::SizedCostFunction<2, 7, 3, kLensParameters> {
 public:
  LensReprojectionCost(const CameraModel& camera, const Eigen::Vector2d& pixel)
      : camera_(camera), pixel_(pixel) {}

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  const CameraModel& camera_;
  Eigen::Vector2d pixel_;
};

}  // namespace handeye
