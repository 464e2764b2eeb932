// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include <Eigen/QR>
#include <ceres/ceres.h>

/// What the non-linear methods share. Their residuals are few monomials of few unknowns with one
/// set of coefficients a movement, so the movements are folded into a triangle once and the
/// minimiser never sees how many there were.
namespace handeye {

/// Weight of the paper's constraints (Schmidt 2005, eqs 7 and 15; Horaud and Dornaika 1995).
inline constexpr double kConstraintWeight = 2e6;

/// Below this part of the start a scale has collapsed. Where a fixed point hides the scale
/// (docs/math.md section 10) the functions may fall for ever towards s = 0 and have no minimum.
inline constexpr double kCollapsedScale = 1e-6;

/// The n x n triangle with |triangle z| = |rows z| for every z. By QR, not by rows^T rows, which
/// would halve the digits.
template <int n>
Eigen::Matrix<double, n, n> triangle_of(const Eigen::Matrix<double, Eigen::Dynamic, n>& rows) {
  const Eigen::HouseholderQR<Eigen::Matrix<double, Eigen::Dynamic, n>> qr(rows);
  const Eigen::Index height = std::min<Eigen::Index>(rows.rows(), n);
  Eigen::Matrix<double, n, n> triangle = Eigen::Matrix<double, n, n>::Zero();
  triangle.topRows(height) = qr.matrixQR().topRows(height);
  triangle.template triangularView<Eigen::StrictlyLower>().setZero();
  return triangle;
}

/// Minimises a problem of a few unknowns to the last digit: with the movements folded, an iteration
/// costs microseconds. True when the result can be used.
inline bool minimise_to_the_last_digit(ceres::Problem& problem) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.num_threads = 1;
  options.max_num_iterations = 100;
  options.function_tolerance = 1e-16;
  options.gradient_tolerance = 1e-20;
  options.parameter_tolerance = 1e-16;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary.IsSolutionUsable();
}

}  // namespace handeye
