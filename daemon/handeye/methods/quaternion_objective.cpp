// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/methods/quaternion_objective.hpp"

#include <array>
#include <cmath>

#include <ceres/rotation.h>

#include "daemon/handeye/methods/least_squares.hpp"
#include "daemon/handeye/methods/signed_quaternions.hpp"

namespace handeye {
namespace {

constexpr int kResiduals = 4 + 13 + 1;

/// The vector of Q((I - R_E) t - t_E) + q Q(s t_H) q*, whose real part is zero, on
/// (s M by rows, t, 1).
Eigen::Matrix<double, 3, 13> translation_rows(const Movement& movement) {
  const auto& [hand, eye] = movement;
  Eigen::Matrix<double, 3, 13> rows = Eigen::Matrix<double, 3, 13>::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) rows.block<1, 3>(i, 3 * i) = hand.translation().transpose();
  rows.block<3, 3>(0, 9) = Eigen::Matrix3d::Identity() - eye.linear();
  rows.col(12) = -eye.translation();
  return rows;
}

struct Residual {
  const QuaternionObjective::Folded& folded;

  template <typename T>
  bool operator()(const T* q, const T* t, const T* s, T* residuals) const {
    Eigen::Matrix<T, 13, 1> monomials;
    ceres::QuaternionToScaledRotation(q, monomials.data());  // |q|^2 R(q), by rows
    monomials.template head<9>() *= *s;
    monomials.template segment<3>(9) = Eigen::Map<const Eigen::Matrix<T, 3, 1>>(t);
    monomials[12] = T(1);
    const Eigen::Map<const Eigen::Matrix<T, 4, 1>> entries(q);

    Eigen::Map<Eigen::Matrix<T, kResiduals, 1>> all(residuals);
    all.template head<4>() = folded.rotation.cast<T>() * entries;
    all.template segment<13>(4) = folded.translation.cast<T>() * monomials;
    all[17] = std::sqrt(kConstraintWeight) * (T(1) - entries.squaredNorm());
    return true;
  }
};

std::array<double, 4> entries_of(const Eigen::Quaterniond& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}

}  // namespace

QuaternionObjective::QuaternionObjective(std::span<const Movement> movements,
                                         const Eigen::Quaterniond& about) {
  const auto n = static_cast<Eigen::Index>(movements.size());
  Eigen::Matrix<double, Eigen::Dynamic, 4> rotation(4 * n, 4);
  Eigen::Matrix<double, Eigen::Dynamic, 13> translation(3 * n, 13);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Movement& movement = movements[static_cast<std::size_t>(k)];
    rotation.middleRows<4>(4 * k) = rotation_rows(signed_quaternions(movement, about));
    translation.middleRows<3>(3 * k) = translation_rows(movement);
  }
  folded_ = {triangle_of<4>(rotation), triangle_of<13>(translation)};
}

double QuaternionObjective::value(const QuaternionUnknowns& x) const {
  const std::array<double, 4> q = entries_of(x.q);
  Eigen::Matrix<double, kResiduals, 1> residuals;
  Residual{folded_}(q.data(), x.t.data(), &x.s, residuals.data());
  return residuals.squaredNorm();
}

std::optional<QuaternionUnknowns> QuaternionObjective::minimise(
    const QuaternionUnknowns& start, const QuaternionOptions& options) const {
  std::array<double, 4> q = entries_of(start.q);
  Eigen::Vector3d t = start.t;
  double s = start.s;
  ceres::Problem problem;
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<Residual, kResiduals, 4, 3, 1>(new Residual{folded_}),
      nullptr, q.data(), t.data(), &s);
  if (!options.free_scale) problem.SetParameterBlockConstant(&s);
  if (options.unit_norm == QuaternionOptions::UnitNorm::kManifold) {
    problem.SetManifold(q.data(), new ceres::QuaternionManifold);
  }
  if (!minimise_to_the_last_digit(problem)) return std::nullopt;
  const QuaternionUnknowns found{{q[0], q[1], q[2], q[3]}, t, s};
  if (!found.q.coeffs().allFinite() || !found.t.allFinite()) return std::nullopt;
  if (!(s > kCollapsedScale * start.s)) return std::nullopt;
  return found;
}

std::optional<Pose> horaud_hand_from_eye(std::span<const Movement> metric, const Pose& start) {
  const Pose eye_from_hand = start.inverse();
  const Eigen::Quaterniond q(eye_from_hand.linear());
  const auto found = QuaternionObjective(metric, q).minimise({q, eye_from_hand.translation(), 1.0},
                                                             {.free_scale = false});
  if (!found) return std::nullopt;
  return make_pose(found->q, found->t).inverse();
}

}  // namespace handeye
