// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <vector>

#include "daemon/handeye/linear_parts.hpp"
#include "daemon/handeye/methods/methods.hpp"
#include "daemon/handeye/methods/signed_quaternions.hpp"

// Park, Martin 1994, "Robot sensor calibration: solving AX = XB on the Euclidean group": with
// alpha = log R_E and beta = log R_H, R_X minimises sum |alpha_i - R_X beta_i|^2 (their eq 18). The
// polar factor (M^T M)^(-1/2) M^T of M = sum beta_i alpha_i^T (eq 19) is that minimiser for three
// and more axes; found without M, which squares the condition, it also is for two.
namespace handeye {
namespace {

/// Rotation vector, |w| in [0, 2 pi], that does not jump at half a turn.
Eigen::Vector3d log_of(const Eigen::Quaterniond& q) {
  const double sine = q.vec().norm();
  const double angle = 2.0 * std::atan2(sine, q.w());
  return sine > 0 ? Eigen::Vector3d(angle / sine * q.vec()) : Eigen::Vector3d::Zero();
}

std::optional<Eigen::Matrix3d> rotation_by_logarithms(std::span<const Movement> movements) {
  const auto about = eye_from_hand_rotation(movements);
  if (!about) return std::nullopt;
  const Eigen::Quaterniond q_about(*about);
  std::vector<VectorPair> logarithms;
  logarithms.reserve(movements.size());
  for (const Movement& movement : movements) {
    auto [hand, eye] = signed_quaternions(movement, q_about);
    // Both signs together: the hand's angle at most half a turn, the eye's near it.
    if (hand.w() < 0) {
      hand.coeffs() = -hand.coeffs();
      eye.coeffs() = -eye.coeffs();
    }
    logarithms.push_back({log_of(hand), log_of(eye)});
  }
  return rotation_between(logarithms);
}

}  // namespace

std::optional<HandEyeSolution> park_martin(const HandEyeProblem& problem) {
  return rotation_then_translation(problem, rotation_by_logarithms);
}

}  // namespace handeye
