// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/body_covariance.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>

namespace handeye {
namespace {

constexpr double kLeastPosition_mm = 1e-4;
constexpr double kMostPosition_mm = 100.0;
constexpr double kLeastAngle_rad = 1e-7;
constexpr double kMostAngle_rad = 0.5;
constexpr double kMostLever_mm = 2000.0;
// Four printed digits leave a correlation matrix this far from semi-definite at most.
constexpr double kRounding = 5e-3;
// What is left of an eigenvalue that rounding took.
constexpr double kLeastEigenvalue = 1e-6;

bool is_plausible(const Vector6d& sigma) {
  const auto within = [](double value, double least, double most) {
    return value >= least && value <= most;  // false for NaN
  };
  for (int i = 0; i < 3; ++i) {
    if (!within(sigma[i], kLeastPosition_mm, kMostPosition_mm) ||
        !within(sigma[i + 3], kLeastAngle_rad, kMostAngle_rad)) {
      return false;
    }
  }
  return true;
}

/// The covariance as it was before rounding, so to speak: positive definite.
std::optional<Matrix6d> mended(const Matrix6d& covariance) {
  if (!covariance.allFinite()) return std::nullopt;
  const Vector6d sigma = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  if (!is_plausible(sigma)) return std::nullopt;
  const Vector6d inverse = sigma.cwiseInverse();
  const Matrix6d correlation = inverse.asDiagonal() * covariance * inverse.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(correlation);
  if (eigen.info() != Eigen::Success || eigen.eigenvalues()[0] < -kRounding) return std::nullopt;
  const Matrix6d directions = sigma.asDiagonal() * eigen.eigenvectors();
  return directions * eigen.eigenvalues().cwiseMax(kLeastEigenvalue).asDiagonal() *
         directions.transpose();
}

/// w of small changes of (eta, theta, phi) in R = Rx(eta) Ry(theta) Rz(phi).
Eigen::Matrix3d turn_from_euler(const Eigen::Matrix3d& rotation) {
  const double eta = std::atan2(-rotation(1, 2), rotation(2, 2));
  const Eigen::Matrix3d about_x =
      Eigen::AngleAxisd(eta, Eigen::Vector3d::UnitX()).toRotationMatrix();
  Eigen::Matrix3d turn;
  turn.col(0) = Eigen::Vector3d::UnitX();
  turn.col(1) = about_x.col(1);
  turn.col(2) = rotation.col(2);  // Rx Ry e_z, for Rz leaves e_z alone
  return turn;
}

}  // namespace

std::optional<Eigen::Matrix<float, 6, 6>> covariance_of_body(const dtrack::BodyCovariance& said,
                                                             const Pose& room_from_body) {
  const Eigen::Vector3d lever_mm = said.reference_point_mm - room_from_body.translation();
  if (!(lever_mm.norm() <= kMostLever_mm)) return std::nullopt;
  const std::optional<Matrix6d> covariance = mended(said.covariance);
  if (!covariance) return std::nullopt;
  const Eigen::Matrix3d turn = turn_from_euler(room_from_body.linear());
  Matrix6d jacobian = Matrix6d::Zero();  // of (w, dt) by (dp, d Euler)
  jacobian.topRightCorner<3, 3>() = turn;
  jacobian.bottomLeftCorner<3, 3>().setIdentity();
  jacobian.bottomRightCorner<3, 3>() = skew(lever_mm) * turn;
  return Matrix6d(jacobian * *covariance * jacobian.transpose()).cast<float>();
}

}  // namespace handeye
