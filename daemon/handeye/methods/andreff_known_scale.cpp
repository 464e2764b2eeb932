// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <Eigen/Dense>

#include "daemon/handeye/linear_parts.hpp"
#include "daemon/handeye/methods/methods.hpp"

// Andreff, Horaud, Espiau 1999 and 2001, "Robot hand-eye calibration using structure from motion":
// linear in the nine entries of R_X and in t_X. In two steps, as they advise for the sake of
// orthogonality: V with R_E V - V R_H = 0 and det V = 1, the nearest rotation, then t_X.
namespace handeye {
namespace {

constexpr double kMinConditioning = 1e-9;  // second smallest singular value to the largest

std::optional<Eigen::Matrix3d> rotation_by_entries(std::span<const Movement> movements) {
  Eigen::MatrixXd stacked(9 * static_cast<Eigen::Index>(movements.size()), 9);
  for (std::size_t k = 0; k < movements.size(); ++k) {
    stacked.middleRows<9>(9 * static_cast<Eigen::Index>(k)) = entry_rows(movements[k]);
  }
  const auto [vectors, values] = right_singular(stacked);
  if (!(values[7] > kMinConditioning * values[0])) return std::nullopt;
  const Eigen::Matrix3d matrix = vectors.col(8).reshaped<Eigen::RowMajor>(3, 3);
  return nearest_rotation(matrix.determinant() < 0 ? Eigen::Matrix3d(-matrix) : matrix);
}

}  // namespace

std::optional<HandEyeSolution> andreff_known_scale(const HandEyeProblem& problem) {
  return rotation_then_translation(problem, rotation_by_entries);
}

}  // namespace handeye
