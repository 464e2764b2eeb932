// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/noise_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Dense>

namespace handeye {
namespace {

constexpr int kIterations = 30;
constexpr double kSmallestShare = 1e-4;  // of the start's variance: a component never vanishes

/// What each variance contributes to the covariance.
std::array<Matrix6d, 3> components(const Eigen::Vector3d& lever_arm_mm) {
  Eigen::Matrix<double, 6, 3> hand_rotation;
  hand_rotation << -Eigen::Matrix3d::Identity(), skew(lever_arm_mm);
  std::array<Matrix6d, 3> result;
  result[0] = hand_rotation * hand_rotation.transpose();
  result[1] = Matrix6d::Zero();
  result[1].topLeftCorner<3, 3>().setIdentity();
  result[2] = Matrix6d::Zero();
  result[2].bottomRightCorner<3, 3>().setIdentity();
  return result;
}

}  // namespace

Matrix6d ResidualNoise::covariance(const Variances& variances) const {
  const auto parts = components(lever_arm_mm_);
  return variances.hand_rotation * parts[0] + variances.eye_rotation * parts[1] +
         variances.translation * parts[2];
}

Matrix6d ResidualNoise::whitening(const Variances& variances) const {
  const Eigen::LLT<Matrix6d> cholesky(covariance(variances));
  return cholesky.matrixL().solve(Matrix6d::Identity());
}

ResidualNoise::Variances ResidualNoise::estimate(const Matrix6d& mean_square,
                                                 const Variances& start) const {
  const auto parts = components(lever_arm_mm_);
  const Eigen::Vector3d smallest =
      kSmallestShare * Eigen::Vector3d(start.hand_rotation, start.eye_rotation, start.translation);
  // In shares of the start, so that rad^2 and mm^2 compare.
  const Eigen::Vector3d unit = smallest / kSmallestShare;
  Eigen::Vector3d theta = Eigen::Vector3d::Ones();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const Eigen::Vector3d variances = theta.cwiseProduct(unit);
    const Matrix6d inverse =
        covariance({variances[0], variances[1], variances[2]}).llt().solve(Matrix6d::Identity());
    std::array<Matrix6d, 3> weighted;
    for (int i = 0; i < 3; ++i) {
      weighted[static_cast<std::size_t>(i)] =
          unit[i] * inverse * parts[static_cast<std::size_t>(i)];
    }
    Eigen::Matrix3d information;
    Eigen::Vector3d right;
    for (int i = 0; i < 3; ++i) {
      const Matrix6d& a = weighted[static_cast<std::size_t>(i)];
      right[i] = (a * inverse * mean_square).trace();
      for (int j = 0; j < 3; ++j) {
        information(i, j) = (a * weighted[static_cast<std::size_t>(j)]).trace();
      }
    }
    // Hand and eye rotation are one where the lever arm is short: the step of least length.
    const Eigen::Vector3d step =
        information.completeOrthogonalDecomposition().solve(right - information * theta);
    const Eigen::Vector3d next = (theta + step).cwiseMax(kSmallestShare);
    const bool settled = (next - theta).norm() < 1e-10 * theta.norm();
    theta = next;
    if (settled) break;
  }
  const Eigen::Vector3d variances = theta.cwiseProduct(unit);
  return {variances[0], variances[1], variances[2], start.eye_share};
}

ResidualNoise::Variances variances_of(const PoseNoise& noise) {
  const auto square = [](double x) { return x * x; };
  const double eye = square(noise.eye_translation_mm);
  const double translation = square(noise.hand_translation_mm) + eye;
  return {square(noise.hand_rotation_rad), square(noise.eye_rotation_rad), translation,
          eye / translation};
}

PoseNoise noise_of(const ResidualNoise::Variances& variances) {
  return {std::sqrt(variances.hand_rotation),
          std::sqrt((1.0 - variances.eye_share) * variances.translation),
          std::sqrt(variances.eye_rotation),
          std::sqrt(variances.eye_share * variances.translation)};
}

}  // namespace handeye
