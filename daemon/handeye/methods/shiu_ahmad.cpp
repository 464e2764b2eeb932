// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include <Eigen/Dense>

#include "daemon/handeye/linear_parts.hpp"
#include "daemon/handeye/methods/methods.hpp"
#include "daemon/handeye/methods/signed_quaternions.hpp"

// Shiu, Ahmad 1989, "Calibration of wrist-mounted robotic sensors by solving homogeneous transform
// equations of the form AX = XB". Of one movement, R_X is known up to a turn b about the eye's axis
// (their theorem 2): R_X = Rot(n_E, b) R_0 with R_0 n_H = n_E, which is
//   R_X = n_E n_H^T + cos b (I - n_E n_E^T) R_0 + sin b skew(n_E) R_0,
// linear in (cos b, sin b). They equate this for two movements and solve for the two cosines and
// sines; with n movements their system grows to 2n unknowns. The same least squares over all pairs
// of movements is that against the pairs' common mean: nine unknowns, the entries of R_X, with each
// movement's cosine and sine eliminated. All axes count the same, as printed.
namespace handeye {
namespace {

using Matrix9d = Eigen::Matrix<double, 9, 9>;
using Vector9d = Eigen::Matrix<double, 9, 1>;

constexpr double kSmallestHalfSine = 1e-9;  // below it a movement has no axis

Vector9d entries_of(const Eigen::Matrix3d& matrix) {
  return matrix.reshaped();
}

std::optional<Eigen::Matrix3d> rotation_by_axes(std::span<const Movement> movements) {
  const auto about = eye_from_hand_rotation(movements);
  if (!about) return std::nullopt;
  const Eigen::Quaterniond q_about(*about);
  const auto n = static_cast<Eigen::Index>(movements.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(9 * n, 9);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(9 * n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto [hand, eye] = signed_quaternions(movements[static_cast<std::size_t>(k)], q_about);
    if (!(std::min(hand.vec().norm(), eye.vec().norm()) > kSmallestHalfSine)) continue;
    const Eigen::Vector3d n_hand = hand.vec().normalized();
    const Eigen::Vector3d n_eye = eye.vec().normalized();
    const Eigen::Matrix3d r0 = Eigen::Quaterniond::FromTwoVectors(n_hand, n_eye).toRotationMatrix();
    const Eigen::Matrix3d along_axis = n_eye * n_hand.transpose();
    const Vector9d cosine = entries_of(r0 - along_axis).normalized();
    const Vector9d sine = entries_of(skew(n_eye) * r0).normalized();
    const Matrix9d remainder =
        Matrix9d::Identity() - cosine * cosine.transpose() - sine * sine.transpose();
    matrix.middleRows<9>(9 * k) = remainder;
    right.segment<9>(9 * k) = remainder * entries_of(along_axis);
  }
  const auto entries = least_squares(matrix, right);
  if (!entries) return std::nullopt;
  return nearest_rotation(entries->reshaped(3, 3));
}

}  // namespace

std::optional<HandEyeSolution> shiu_ahmad(const HandEyeProblem& problem) {
  return rotation_then_translation(problem, rotation_by_axes);
}

}  // namespace handeye
