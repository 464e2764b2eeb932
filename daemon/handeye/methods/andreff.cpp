// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <Eigen/Dense>

#include "daemon/handeye/linear_parts.hpp"
#include "daemon/handeye/methods/methods.hpp"
#include "daemon/handeye/movements.hpp"

namespace handeye {
namespace {

constexpr double kMinConditioning = 1e-9;  // second smallest singular value to the largest

/// Rows on (vec R_X by rows, t_X, lambda): R_E R_X - R_X R_H = 0 and
/// (I - R_E) t_X - lambda t_E + R_X t_H = 0.
Eigen::Matrix<double, 12, 13> rows_of(const Movement& movement) {
  const auto& [hand, eye] = movement;
  Eigen::Matrix<double, 12, 13> rows = Eigen::Matrix<double, 12, 13>::Zero();
  rows.topLeftCorner<9, 9>() = entry_rows(movement);
  for (Eigen::Index i = 0; i < 3; ++i)
    rows.block<1, 3>(9 + i, 3 * i) = hand.translation().transpose();
  rows.block<3, 3>(9, 9) = Eigen::Matrix3d::Identity() - eye.linear();
  rows.block<3, 1>(9, 12) = -eye.translation();
  return rows;
}

}  // namespace

std::optional<HandEyeSolution> andreff(const HandEyeProblem& problem) {
  const auto normalised = normalise(problem.movements);
  if (!normalised) return std::nullopt;
  const std::vector<Movement>& all = normalised->movements;
  Eigen::MatrixXd stacked(12 * static_cast<Eigen::Index>(all.size()), 13);
  for (std::size_t k = 0; k < all.size(); ++k) {
    stacked.middleRows<12>(12 * static_cast<Eigen::Index>(k)) = rows_of(all[k]);
  }
  const RightSingular singular = right_singular(stacked);
  if (!(singular.values[11] > kMinConditioning * singular.values[0])) return std::nullopt;

  // The singular vector is the solution up to a factor; det R_X = 1 fixes it.
  Eigen::VectorXd solution = singular.vectors.col(12);
  const Eigen::Matrix3d free_matrix = solution.head<9>().reshaped<Eigen::RowMajor>(3, 3);
  const double factor = std::cbrt(free_matrix.determinant());
  if (!std::isnormal(factor)) return std::nullopt;
  solution /= factor;
  const double mm_per_unit = solution[12];
  if (!solution.allFinite() || !(mm_per_unit > 0)) return std::nullopt;
  Pose eye_from_hand = Pose::Identity();
  eye_from_hand.linear() = nearest_rotation(free_matrix / factor);
  eye_from_hand.translation() = solution.segment<3>(9);
  return normalised->restore(eye_from_hand, 1.0 / mm_per_unit);
}

}  // namespace handeye
