// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/perspective_alternation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

namespace handeye {
namespace {

/// The perspective terms k.s/z are held within these bounds: at 1 the point would be in the camera.
constexpr double kLargestTerm = 0.6;
/// Undamped, a tenth to a fifth of the runs diverge.
constexpr double kDamping = 0.5;

/// The matrix of O(3), rotation or reflection, that brings `moved * O` nearest to `fixed`.
Eigen::Matrix3d orthogonal_procrustes(const Eigen::MatrixXd& moved, const Eigen::MatrixXd& fixed) {
  const Eigen::Matrix3d correlation = moved.transpose() * fixed;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(correlation,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

/// Error under true perspective, and whether everything is in front.
void judge(const Eigen::MatrixXd& rays, PerspectiveSolution& solution) {
  solution.in_front = true;
  double sum = 0.0;
  for (std::size_t f = 0; f < solution.eye_from_scene.size(); ++f) {
    const Eigen::Matrix3Xd eye = solution.eye_from_scene[f] * solution.points_scene;
    const auto row = static_cast<Eigen::Index>(2 * f);
    if (!(eye.row(2).minCoeff() > 0)) {
      solution.in_front = false;
      solution.error = std::numeric_limits<double>::infinity();
      return;
    }
    const auto depth = eye.row(2).array();
    sum += (eye.row(0).array() / depth - rays.row(row).array()).square().sum();
    sum += (eye.row(1).array() / depth - rays.row(row + 1).array()).square().sum();
  }
  solution.error = std::sqrt(2.0 * sum / static_cast<double>(rays.size()));
}

/// epsilon_fp = k_f . s_p / z_f, a row a frame.
Eigen::MatrixXd perspective_terms(const PerspectiveSolution& solution) {
  Eigen::MatrixXd terms(static_cast<Eigen::Index>(solution.eye_from_scene.size()),
                        solution.points_scene.cols());
  for (Eigen::Index f = 0; f < terms.rows(); ++f) {
    const Pose& pose = solution.eye_from_scene[static_cast<std::size_t>(f)];
    terms.row(f) = pose.linear().row(2) * solution.points_scene / pose.translation().z();
  }
  return terms;
}

}  // namespace

PerspectiveSolution solve_perspective(const Eigen::MatrixXd& rays, Reversal reversal,
                                      const AlternationOptions& options) {
  PerspectiveSolution best;
  best.error = std::numeric_limits<double>::infinity();
  Eigen::MatrixXd terms = Eigen::MatrixXd::Zero(rays.rows() / 2, rays.cols());
  Eigen::MatrixXd corrected = rays;
  Eigen::MatrixXd last_motion;
  int pass = 0;
  for (; pass < options.max_passes; ++pass) {
    const AffineFactorisation affine = factorise(corrected);
    const MetricUpgrade metric = upgrade_to_metric(affine);
    if (pass == 0) best.outcome = metric.outcome;
    if (metric.outcome == MetricOutcome::kIndefinite) break;

    Eigen::MatrixXd motion = affine.motion * metric.upgrade;
    Eigen::Matrix3Xd shape = metric.upgrade.inverse() * affine.shape;
    // Stay on the branch: of the two reversed scenes the one of the pass before.
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    if (pass > 0) {
      turn = orthogonal_procrustes(motion, last_motion);
    } else if (reversal == Reversal::kMirrored) {
      turn = -turn;
    }
    motion = motion * turn;
    shape = turn.transpose() * shape;
    last_motion = motion;

    PerspectiveSolution current;
    current.outcome = metric.outcome;
    current.sigma = affine.sigma;
    current.pass = pass;
    current.eye_from_scene = recover_poses(affine.centroid, motion);
    current.points_scene = std::move(shape);
    judge(rays, current);
    if (current.error < best.error || best.eye_from_scene.empty()) best = current;

    // (F10) damped and bounded, then (F9).
    const Eigen::MatrixXd next = ((1.0 - kDamping) * terms + kDamping * perspective_terms(current))
                                     .cwiseMax(-kLargestTerm)
                                     .cwiseMin(kLargestTerm);
    const double change = (next - terms).cwiseAbs().maxCoeff();
    terms = next;
    if (!(change >= options.settled)) break;
    for (Eigen::Index row = 0; row < rays.rows(); ++row) {
      corrected.row(row) =
          rays.row(row).array() +
          terms.row(row / 2).array() * (rays.row(row).array() - affine.centroid(row));
    }
  }
  best.passes = pass;
  return best;
}

}  // namespace handeye
