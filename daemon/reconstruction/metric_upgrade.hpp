// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "daemon/geometry/pose.hpp"
#include "daemon/reconstruction/factorisation.hpp"

namespace handeye {

/// What became of the metric constraints.
enum class MetricOutcome {
  kLinear,      ///< Q of the linear equations is positive definite
  kMinimised,   ///< it was not; minimising over A (Q = A A^T) found one that meets the constraints
  kIndefinite,  ///< refused: no positive definite Q meets the constraints
};

struct MetricUpgrade {
  MetricOutcome outcome{MetricOutcome::kIndefinite};
  Eigen::Matrix3d upgrade{Eigen::Matrix3d::Identity()};  ///< A: M = M^ A, S = A^-1 S^
  double residual{0};  ///< rms of the constraints, relative to the squared length of the rows
};

/// Finds A from the paraperspective metric constraints on the rows of M^ (Poelman & Kanade 1997;
/// docs/math.md eqs F4-F6). A is known up to a factor in O(3): a rotation of the scene, and the
/// reversal that makes it the mirrored one.
MetricUpgrade upgrade_to_metric(const AffineFactorisation& affine);

/// Camera poses (eye_from_scene, origin in the centroid of the features) from the metric motion
/// M = M^ A: eqs F7, F8. One for each two rows.
std::vector<Pose> recover_poses(const Eigen::VectorXd& centroid, const Eigen::MatrixXd& motion);

}  // namespace handeye
