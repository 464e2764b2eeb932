// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/metric_upgrade.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace handeye {
namespace {

/// Eigenvalues of Q below this share of the largest are none: the linear Q is not used.
constexpr double kMinEigenvalueRatio = 1e-4;
/// Smallest eigenvalue of a minimised Q, relative to the largest of the linear one. The rows of M^
/// are scaled so that a scene with some depth has eigenvalues of one order.
constexpr double kFloorRatio = 0.2;
/// What an eigenvalue below the floor stands above it where the minimisation begins.
constexpr double kStartRatio = 0.05;
constexpr int kMaxIterations = 40;
/// The constraints hold if their rms is below this share of the rows' squared length.
constexpr double kMaxResidual = 0.1;

using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix9d = Eigen::Matrix<double, 9, 9>;

/// sum_k factor_k * a_k^T Q b_k = right, over up to three pairs of rows of M^.
struct Constraint {
  Eigen::Matrix3d form;  ///< symmetric B: the left side is trace(B Q)
  double right{0};
};

/// The constraint's left side is linear in the six elements of Q.
Vector6d coefficients(const Eigen::Matrix3d& form) {
  Vector6d row;
  row << form(0, 0), form(1, 1), form(2, 2), 2.0 * form(0, 1), 2.0 * form(0, 2), 2.0 * form(1, 2);
  return row;
}

Eigen::Matrix3d to_symmetric(const Vector6d& q) {
  Eigen::Matrix3d matrix;
  matrix << q(0), q(3), q(4), q(3), q(1), q(5), q(4), q(5), q(2);
  return matrix;
}

/// The forms whose traces with Q are 1/z^2 of a frame, seen in its row m and in its row n.
struct FrameForms {
  Eigen::Matrix3d by_m, by_n, mixed;
  double skewness{0};  ///< x y
};

std::vector<FrameForms> frame_forms(const AffineFactorisation& affine) {
  std::vector<FrameForms> forms;
  for (Eigen::Index row = 0; row + 1 < affine.motion.rows(); row += 2) {
    const Eigen::Vector3d m = affine.motion.row(row);
    const Eigen::Vector3d n = affine.motion.row(row + 1);
    const double x = affine.centroid(row);
    const double y = affine.centroid(row + 1);
    forms.push_back({m * m.transpose() / (1.0 + x * x), n * n.transpose() / (1.0 + y * y),
                     0.5 * (m * n.transpose() + n * m.transpose()), x * y});
  }
  return forms;
}

/// 1/z_f^2 (F4), the mean of what both rows of the frame say.
double inverse_squared_depth(const FrameForms& frame, const Eigen::Matrix3d& q) {
  return 0.5 * ((frame.by_m * q).trace() + (frame.by_n * q).trace());
}

/// (F5) for all frames, each divided by its weight, and the scale.
std::vector<Constraint> metric_constraints(const std::vector<FrameForms>& frames,
                                           const std::vector<double>& weights) {
  std::vector<Constraint> constraints;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const FrameForms& frame = frames[f];
    const Eigen::Matrix3d equal = frame.by_m - frame.by_n;
    const Eigen::Matrix3d square = frame.mixed - 0.5 * frame.skewness * (frame.by_m + frame.by_n);
    constraints.push_back({equal / weights[f], 0.0});
    constraints.push_back({square / weights[f], 0.0});
  }
  constraints.push_back({frames.front().by_m / weights.front(), 1.0});
  return constraints;
}

Eigen::Matrix3d solve_linear(const std::vector<Constraint>& constraints) {
  Eigen::MatrixXd left(static_cast<Eigen::Index>(constraints.size()), 6);
  Eigen::VectorXd right(left.rows());
  for (Eigen::Index i = 0; i < left.rows(); ++i) {
    const Constraint& constraint = constraints[static_cast<std::size_t>(i)];
    left.row(i) = coefficients(constraint.form).transpose();
    right(i) = constraint.right;
  }
  return to_symmetric(left.colPivHouseholderQr().solve(right));
}

double squared_error(const std::vector<Constraint>& constraints, const Eigen::Matrix3d& q) {
  double sum = 0.0;
  for (const Constraint& constraint : constraints) {
    const double error = (constraint.form * q).trace() - constraint.right;
    sum += error * error;
  }
  return sum;
}

/// Levenberg-Marquardt on the constraints over A itself, Q = A A^T: nine unknowns, three of them a
/// rotation of the scene that the damping holds still.
Eigen::Matrix3d minimise_over_factor(const std::vector<Constraint>& constraints,
                                     Eigen::Matrix3d a) {
  double damping = 1e-3;
  double cost = squared_error(constraints, a * a.transpose());
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    Matrix9d normal = Matrix9d::Zero();
    Vector9d gradient = Vector9d::Zero();
    for (const Constraint& constraint : constraints) {
      const Eigen::Matrix3d slope = 2.0 * constraint.form * a;  // d trace(B A A^T) / dA
      const Eigen::Map<const Vector9d> row(slope.data());
      const double error = (constraint.form * a * a.transpose()).trace() - constraint.right;
      normal += row * row.transpose();
      gradient += error * row;
    }
    const double scale = normal.diagonal().maxCoeff();
    const Matrix9d damped = normal + damping * scale * Matrix9d::Identity();
    const Vector9d step = damped.ldlt().solve(gradient);
    const Eigen::Matrix3d next = a - Eigen::Map<const Eigen::Matrix3d>(step.data());
    const double next_cost = squared_error(constraints, next * next.transpose());
    if (!(next_cost < cost)) {
      damping *= 10.0;
      if (damping > 1e6) break;
      continue;
    }
    const bool settled = cost - next_cost < 1e-10 * cost;
    a = next;
    cost = next_cost;
    damping = std::max(1e-9, 0.2 * damping);
    if (settled) break;
  }
  return a;
}

/// The constraints' left sides are linear in Q, so their squares are convex in it: where the
/// minimum over all Q is not positive definite, that over the positive ones has a zero eigenvalue,
/// a scene of infinite depth. So the minimum is sought over Q = A A^T + floor.
Eigen::Matrix3d minimise_above_floor(std::vector<Constraint> constraints,
                                     const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>& linear) {
  const double floor = kFloorRatio * linear.eigenvalues()(2);
  for (Constraint& constraint : constraints) constraint.right -= floor * constraint.form.trace();
  const Eigen::Vector3d above =
      (linear.eigenvalues().array() - floor).max(kStartRatio * floor).sqrt();
  const Eigen::Matrix3d a =
      minimise_over_factor(constraints, linear.eigenvectors() * above.asDiagonal());
  return a * a.transpose() + floor * Eigen::Matrix3d::Identity();
}

}  // namespace

MetricUpgrade upgrade_to_metric(const AffineFactorisation& affine) {
  MetricUpgrade result;
  const std::vector<FrameForms> frames = frame_forms(affine);
  std::vector<double> weights(frames.size(), 1.0);
  auto constraints = metric_constraints(frames, weights);
  Eigen::Matrix3d q = solve_linear(constraints);
  // Once more, each frame's equations divided by its 1/z^2: else the near frames dominate.
  const bool all_positive = std::all_of(frames.begin(), frames.end(), [&](const auto& frame) {
    return inverse_squared_depth(frame, q) > 0;
  });
  if (all_positive) {
    for (std::size_t f = 0; f < frames.size(); ++f) {
      weights[f] = inverse_squared_depth(frames[f], q);
    }
    constraints = metric_constraints(frames, weights);
    q = solve_linear(constraints);
  }
  if (!q.allFinite()) return result;

  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(q);
  if (eigen.eigenvalues()(2) < 0) eigen.compute(-q);  // only the sign of Q was wrong
  if (!(eigen.eigenvalues()(2) > 0)) return result;
  result.outcome = MetricOutcome::kLinear;
  if (eigen.eigenvalues()(0) <= kMinEigenvalueRatio * eigen.eigenvalues()(2)) {
    result.outcome = MetricOutcome::kMinimised;
    eigen.compute(minimise_above_floor(constraints, eigen));
  }
  // (F6) A = E Lambda^(1/2), in the scale of the last constraint.
  q = eigen.eigenvectors() * eigen.eigenvalues().asDiagonal() * eigen.eigenvectors().transpose();
  const double scale = (constraints.back().form * q).trace();
  result.upgrade = eigen.eigenvectors() * (eigen.eigenvalues() / scale).cwiseSqrt().asDiagonal();
  result.residual =
      std::sqrt(squared_error(constraints, q / scale) / static_cast<double>(constraints.size()));
  if (!(result.residual <= kMaxResidual)) result.outcome = MetricOutcome::kIndefinite;
  return result;
}

std::vector<Pose> recover_poses(const Eigen::VectorXd& centroid, const Eigen::MatrixXd& motion) {
  std::vector<Pose> poses;
  for (Eigen::Index row = 0; row + 1 < motion.rows(); row += 2) {
    const Eigen::Vector3d m = motion.row(row);
    const Eigen::Vector3d n = motion.row(row + 1);
    const double x = centroid(row);
    const double y = centroid(row + 1);
    // (F7) depth of the centroid, then i - x k and j - y k.
    const double z =
        std::sqrt(2.0 / (m.squaredNorm() / (1.0 + x * x) + n.squaredNorm() / (1.0 + y * y)));
    const Eigen::Vector3d a = z * m;
    const Eigen::Vector3d b = z * n;
    // (F8) Its determinant is 1 + x^2 + y^2.
    Eigen::Matrix3d left;
    left << 1, 0, -x, 0, 1, -y, x, y, 1;
    Eigen::Matrix3d right;
    right << a.transpose(), b.transpose(), a.cross(b).transpose();
    Pose pose = Pose::Identity();
    pose.linear() = nearest_rotation(left.inverse() * right);
    pose.translation() = z * Eigen::Vector3d(x, y, 1.0);
    poses.push_back(pose);
  }
  return poses;
}

}  // namespace handeye
