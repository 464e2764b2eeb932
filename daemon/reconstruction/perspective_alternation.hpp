// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "daemon/geometry/pose.hpp"
#include "daemon/reconstruction/metric_upgrade.hpp"

namespace handeye {

/// Which of the two scenes with the same affine images.
enum class Reversal { kFirst, kMirrored };

/// Cameras and points that explain the rays, found by factorisation.
struct PerspectiveSolution {
  MetricOutcome outcome{MetricOutcome::kIndefinite};  ///< of the pass that it comes from
  std::vector<Pose> eye_from_scene;                   ///< a frame each
  Eigen::Matrix3Xd points_scene;
  double error{0};       ///< rms distance of rays and projections, normalised coordinates
  bool in_front{false};  ///< all points lie in front of all cameras
  Eigen::Vector4d sigma{Eigen::Vector4d::Zero()};  ///< singular values of that pass
  int pass{0};                                     ///< of `passes`, from 0: the paraperspective one
  int passes{0};
};

struct AlternationOptions {
  int max_passes{30};
  double settled{1e-6};  ///< largest change of the perspective terms that ends it
};

/// Paraperspective factorisation, then from pass to pass nearer to perspective (Christy & Horaud,
/// PAMI 18(11), 1996; docs/math.md eqs F9, F10). Every pass is judged by its error under true
/// perspective; the best is returned. Without eye_from_scene when the first pass finds no positive
/// definite metric (`outcome` says so).
/// `rays`: as for `factorise`.
PerspectiveSolution solve_perspective(const Eigen::MatrixXd& rays, Reversal reversal,
                                      const AlternationOptions& options = {});

}  // namespace handeye
