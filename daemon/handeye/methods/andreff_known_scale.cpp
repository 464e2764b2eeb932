// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <Eigen/Dense>

#include "daemon/handeye/linear_parts.hpp"
#include "daemon/handeye/methods/methods.hpp"
#include "daemon/handeye/movements.hpp"
#include "daemon/handeye/translation_weights.hpp"

// Andreff, Horaud, Espiau 1999 and 2001, "Robot hand-eye calibration using structure from motion":
// R_E V - V R_H = 0 and (I - R_E) t_X + V t_H = t_E, linear in the nine entries of V and in t_X;
// then R_X is the rotation nearest to V, and t_X is solved for again with it, as they advise for
// the sake of orthogonality. Translation equations are weighted by `translation_weights`. One
// equation is added: the length of V along a first solution R_0 is that of a rotation,
// R_0 . V = 3. Where all movements keep one point the printed system is singular, because a factor
// of V can be traded for t_X.
namespace handeye {
namespace {

constexpr int kWeightRounds = 2;
constexpr double kLengthWeight = 10;  // of the length's equation, in root mean movements

Eigen::MatrixXd triangle_of(const Eigen::MatrixXd& tall) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(tall);
  const Eigen::Index n = std::min(tall.rows(), tall.cols());
  return qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
}

/// The whole system for given weights. `rotation_triangle`: of all movements' rows on V alone;
/// `first`: R_0.
std::optional<Eigen::Matrix3d> rotation_of(std::span<const Movement> movements,
                                           const Eigen::MatrixXd& rotation_triangle,
                                           const std::vector<double>& weights,
                                           const Eigen::Matrix3d& first) {
  const auto n = static_cast<Eigen::Index>(movements.size());
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(3 * n + 10, 12);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(3 * n + 10);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto& [hand, eye] = movements[static_cast<std::size_t>(k)];
    const double weight = weights[static_cast<std::size_t>(k)];
    for (Eigen::Index i = 0; i < 3; ++i) {
      rows.block<1, 3>(3 * k + i, 3 * i) = weight * hand.translation().transpose();
    }
    rows.block<3, 3>(3 * k, 9) = weight * (Eigen::Matrix3d::Identity() - eye.linear());
    right.segment<3>(3 * k) = weight * eye.translation();
  }
  rows.block<9, 9>(3 * n, 0) = rotation_triangle;
  const double length_weight = kLengthWeight * std::sqrt(static_cast<double>(n));
  rows.block<1, 9>(3 * n + 9, 0) = length_weight * first.reshaped<Eigen::RowMajor>().transpose();
  right[3 * n + 9] = length_weight * 3.0;
  const auto solution = least_squares(rows, right);
  if (!solution) return std::nullopt;
  const Eigen::Matrix3d entries = solution->head<9>().reshaped<Eigen::RowMajor>(3, 3);
  return nearest_rotation(entries);
}

std::optional<Pose> with_translation(std::span<const Movement> movements,
                                     const std::optional<Eigen::Matrix3d>& rotation) {
  if (!rotation) return std::nullopt;
  const auto translation = translation_of(movements, *rotation);
  if (!translation) return std::nullopt;
  Pose eye_from_hand = Pose::Identity();
  eye_from_hand.linear() = *rotation;
  eye_from_hand.translation() = *translation;
  return eye_from_hand;
}

}  // namespace

std::optional<HandEyeSolution> andreff_known_scale(const HandEyeProblem& problem) {
  const auto normalised = normalise(problem.movements, ScaleMode::kKnown);
  if (!normalised) return std::nullopt;
  const std::vector<Movement>& movements = normalised->movements;
  Eigen::MatrixXd stacked(9 * static_cast<Eigen::Index>(movements.size()), 9);
  for (std::size_t k = 0; k < movements.size(); ++k) {
    stacked.middleRows<9>(9 * static_cast<Eigen::Index>(k)) = entry_rows(movements[k]);
  }
  const Eigen::MatrixXd rotation_triangle = triangle_of(stacked);
  auto eye_from_hand = with_translation(movements, eye_from_hand_rotation(movements));
  for (int round = 0; eye_from_hand && round < kWeightRounds; ++round) {
    const std::vector<double> weights = translation_weights(movements, *eye_from_hand);
    eye_from_hand = with_translation(
        movements, rotation_of(movements, rotation_triangle, weights, eye_from_hand->linear()));
  }
  if (!eye_from_hand) return std::nullopt;
  return normalised->restore(*eye_from_hand, 1.0);
}

}  // namespace handeye
