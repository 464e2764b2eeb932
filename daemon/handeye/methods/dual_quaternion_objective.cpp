// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/methods/dual_quaternion_objective.hpp"

#include <array>
#include <cmath>

#include "daemon/handeye/linear_parts.hpp"
#include "daemon/handeye/methods/least_squares.hpp"
#include "daemon/handeye/methods/signed_quaternions.hpp"

namespace handeye {
namespace {

using Triangle = Eigen::Matrix<double, 12, 12>;

template <typename T>
using Vector4 = Eigen::Matrix<T, 4, 1>;

constexpr int kResiduals = 12 + 1;

Eigen::Vector4d entries_of(const Eigen::Quaterniond& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}

Eigen::Quaterniond quaternion_of(const Eigen::Vector4d& entries) {
  return {entries[0], entries[1], entries[2], entries[3]};
}

/// The printed function on q_s and q_sd.
struct Residual {
  const Triangle& folded;

  template <typename T>
  bool operator()(const T* real, const T* dual, T* residuals) const {
    const Eigen::Map<const Vector4<T>> q_s(real);
    const Eigen::Map<const Vector4<T>> q_sd(dual);
    Eigen::Matrix<T, 12, 1> monomials;
    monomials << q_s, q_sd, q_s / q_s.norm();
    Eigen::Map<Eigen::Matrix<T, kResiduals, 1>> all(residuals);
    all.template head<12>() = folded.cast<T>() * monomials;
    // q_s q_sd* + q_sd q_s* has no imaginary part.
    all[12] = std::sqrt(kConstraintWeight) * 2.0 * q_s.dot(q_sd);
    return true;
  }
};

/// The same on (q, t, s), where the constraint holds by itself.
struct ConstrainedResidual {
  const Triangle& folded;

  template <typename T>
  bool operator()(const T* q, const T* t, const T* s, T* residuals) const {
    const Eigen::Quaternion<T> rotation(q[0], q[1], q[2], q[3]);
    const Eigen::Quaternion<T> dual = Eigen::Quaternion<T>(T(0), t[0], t[1], t[2]) * rotation;
    const Vector4<T> q_s = *s * Eigen::Map<const Vector4<T>>(q);
    const Vector4<T> q_sd = T(0.5) * Vector4<T>(dual.w(), dual.x(), dual.y(), dual.z());
    return Residual{folded}(q_s.data(), q_sd.data(), residuals);
  }
};

bool minimise_freely(const Triangle& folded, Eigen::Vector4d& real, Eigen::Vector4d& dual) {
  ceres::Problem problem;
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<Residual, kResiduals, 4, 4>(new Residual{folded}), nullptr,
      real.data(), dual.data());
  return minimise_to_the_last_digit(problem);
}

bool minimise_constrained(const Triangle& folded, Eigen::Vector4d& q, Eigen::Vector3d& t,
                          double& s) {
  ceres::Problem problem;
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<ConstrainedResidual, kResiduals, 4, 3, 1>(
          new ConstrainedResidual{folded}),
      nullptr, q.data(), t.data(), &s);
  problem.SetManifold(q.data(), new ceres::QuaternionManifold);
  return minimise_to_the_last_digit(problem);
}

}  // namespace

SimilarityDualQuaternion SimilarityDualQuaternion::from(const Eigen::Quaterniond& q,
                                                        const Eigen::Vector3d& t, double s) {
  return {Eigen::Quaterniond(s * q.coeffs()), dual_part(q, t)};
}

Eigen::Quaterniond SimilarityDualQuaternion::q() const {
  return real.normalized();
}

Eigen::Vector3d SimilarityDualQuaternion::t() const {
  return 2.0 * (dual * q().conjugate()).vec();
}

double SimilarityDualQuaternion::s() const {
  return real.norm();
}

Eigen::Matrix<double, 8, 12> similarity_rows(const Movement& movement,
                                             const Eigen::Quaterniond& about) {
  const SignedQuaternions quaternions = signed_quaternions(movement, about);
  const Eigen::Matrix4d rotation = rotation_rows(quaternions);
  const auto hand_dual = dual_part(quaternions.hand, movement.hand_j_from_hand_i.translation());
  const auto eye_dual = dual_part(quaternions.eye, movement.eye_j_from_eye_i.translation());
  Eigen::Matrix<double, 8, 12> rows = Eigen::Matrix<double, 8, 12>::Zero();
  rows.block<4, 4>(0, 0) = rotation;
  rows.block<4, 4>(4, 0) = -right_product(hand_dual);
  rows.block<4, 4>(4, 4) = rotation;
  rows.block<4, 4>(4, 8) = left_product(eye_dual);
  return rows;
}

DualQuaternionObjective::DualQuaternionObjective(std::span<const Movement> movements,
                                                 const Eigen::Quaterniond& about) {
  Eigen::Matrix<double, Eigen::Dynamic, 12> rows(8 * static_cast<Eigen::Index>(movements.size()),
                                                 12);
  for (std::size_t k = 0; k < movements.size(); ++k) {
    rows.middleRows<8>(8 * static_cast<Eigen::Index>(k)) = similarity_rows(movements[k], about);
  }
  folded_ = triangle_of<12>(rows);
}

double DualQuaternionObjective::value(const SimilarityDualQuaternion& x) const {
  Eigen::Matrix<double, kResiduals, 1> residuals;
  Residual{folded_}(entries_of(x.real).data(), entries_of(x.dual).data(), residuals.data());
  return residuals.squaredNorm();
}

std::optional<SimilarityDualQuaternion> DualQuaternionObjective::minimise(
    const SimilarityDualQuaternion& start, const DualQuaternionOptions& options) const {
  SimilarityDualQuaternion found;
  if (options.constraint == DualQuaternionOptions::Constraint::kPenalty) {
    Eigen::Vector4d real = entries_of(start.real);
    Eigen::Vector4d dual = entries_of(start.dual);
    if (!minimise_freely(folded_, real, dual)) return std::nullopt;
    found = {quaternion_of(real), quaternion_of(dual)};
  } else {
    Eigen::Vector4d q = entries_of(start.q());
    Eigen::Vector3d t = start.t();
    double s = start.s();
    if (!minimise_constrained(folded_, q, t, s)) return std::nullopt;
    found = SimilarityDualQuaternion::from(quaternion_of(q), t, s);
  }
  const bool finite = found.real.coeffs().allFinite() && found.dual.coeffs().allFinite();
  if (!finite || !(found.s() > kCollapsedScale * start.s())) return std::nullopt;
  return found;
}

}  // namespace handeye
