// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/dual_quaternion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "daemon/handeye/linear_parts.hpp"
#include "daemon/handeye/methods/signed_quaternions.hpp"
#include "daemon/handeye/translation_weights.hpp"

namespace handeye {
namespace {

constexpr double kMinConditioning = 1e-9;  // sixth singular value to the first
constexpr int kWeightRounds = 2;

/// One movement's vector parts of q_E q = q q_H and its dual, on (q; q_d), w first.
Eigen::Matrix<double, 6, 8> rows_of(const Movement& movement, const Eigen::Quaterniond& about) {
  const auto [hand, eye] = signed_quaternions(movement, about);
  const Eigen::Quaterniond hand_dual = dual_part(hand, movement.hand_j_from_hand_i.translation());
  const Eigen::Quaterniond eye_dual = dual_part(eye, movement.eye_j_from_eye_i.translation());

  Eigen::Matrix<double, 6, 8> rows = Eigen::Matrix<double, 6, 8>::Zero();
  rows.block<3, 1>(0, 0) = eye.vec() - hand.vec();
  rows.block<3, 3>(0, 1) = skew(eye.vec() + hand.vec());
  rows.block<3, 1>(3, 0) = eye_dual.vec() - hand_dual.vec();
  rows.block<3, 3>(3, 1) = skew(eye_dual.vec() + hand_dual.vec());
  rows.block<3, 4>(3, 4) = rows.block<3, 4>(0, 0);
  return rows;
}

/// The combination of two null vectors (u, v) that is a unit dual quaternion: u.v = 0, |u| = 1. Of
/// the two directions with u.v = 0 it is the one with the longer u.
std::optional<Eigen::Matrix<double, 8, 1>> unit_combination(const Eigen::MatrixXd& null_vectors) {
  const auto u1 = null_vectors.col(0).head<4>();
  const auto v1 = null_vectors.col(0).tail<4>();
  const auto u2 = null_vectors.col(1).head<4>();
  const auto v2 = null_vectors.col(1).tail<4>();
  // a x^2 + b x y + c y^2 = 0, solved in homogeneous form, since either weight may vanish.
  const double a = u1.dot(v1);
  const double b = u1.dot(v2) + u2.dot(v1);
  const double c = u2.dot(v2);
  const double root = std::sqrt(std::max(0.0, b * b - 4 * a * c));
  const double q = -0.5 * (b + std::copysign(root, b));
  const std::array<Eigen::Vector2d, 2> directions{Eigen::Vector2d(q, a), Eigen::Vector2d(c, q)};

  std::optional<Eigen::Matrix<double, 8, 1>> best;
  double longest = 0;
  for (const Eigen::Vector2d& direction : directions) {
    if (!(direction.norm() > 0)) continue;
    const Eigen::Matrix<double, 8, 1> combined = null_vectors * direction.normalized();
    const double length = combined.head<4>().norm();
    if (length > longest) {
      longest = length;
      best = combined / length;
    }
  }
  return best;
}

/// `dual_unit`: the last four columns of the stacked rows are of q_d in this unit.
std::optional<Pose> solve(const Eigen::MatrixXd& stacked, double dual_unit) {
  const RightSingular singular = right_singular(stacked);
  if (!(singular.values[5] > kMinConditioning * singular.values[0])) return std::nullopt;
  const auto solution = unit_combination(singular.vectors.rightCols(2));
  if (!solution) return std::nullopt;
  const auto& x = *solution;
  const Eigen::Quaterniond q(x[0], x[1], x[2], x[3]);
  const Eigen::Quaterniond dual(x[4], x[5], x[6], x[7]);
  return make_pose(q, 2.0 * dual_unit * (dual * q.conjugate()).vec());
}

}  // namespace

std::optional<Pose> eye_from_hand_by_dual_quaternions(std::span<const Movement> movements,
                                                      const Eigen::Matrix3d& about) {
  if (movements.size() < 2) return std::nullopt;
  const auto translation = translation_of(movements, about);
  if (!translation) return std::nullopt;
  Pose first = Pose::Identity();
  first.linear() = about;
  first.translation() = *translation;

  const Eigen::Quaterniond q_about(about);
  Eigen::MatrixXd stacked(6 * static_cast<Eigen::Index>(movements.size()), 8);
  for (std::size_t k = 0; k < movements.size(); ++k) {
    stacked.middleRows<6>(6 * static_cast<Eigen::Index>(k)) = rows_of(movements[k], q_about);
  }
  // With a lever arm much longer than the movements q would be small beside q_d and lose digits.
  const double dual_unit = std::max(1.0, 0.5 * translation->norm());
  stacked.rightCols<4>() *= dual_unit;
  std::optional<Pose> found = first;
  Eigen::MatrixXd weighted = stacked;
  for (int round = 0; found && round < kWeightRounds; ++round) {
    const std::vector<double> weights = translation_weights(movements, *found);
    for (std::size_t k = 0; k < movements.size(); ++k) {
      const Eigen::Index row = 6 * static_cast<Eigen::Index>(k) + 3;
      weighted.middleRows<3>(row) = weights[k] * stacked.middleRows<3>(row);
    }
    found = solve(weighted, dual_unit);
  }
  return found;
}

}  // namespace handeye
