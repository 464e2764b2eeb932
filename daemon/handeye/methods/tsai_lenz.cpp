// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <Eigen/Geometry>

#include "daemon/handeye/linear_parts.hpp"
#include "daemon/handeye/methods/methods.hpp"
#include "daemon/handeye/methods/signed_quaternions.hpp"

// Tsai, Lenz 1989, "A new technique for fully autonomous and efficient 3D robotics hand/eye
// calibration": with P = 2 sin(angle/2) n of each movement and P' = tan(angle/2) n of R_X,
// skew(P_E + P_H) P' = P_H - P_E (eq 12), least squares, then the translation (eq 15).
namespace handeye {
namespace {

/// A known turn of the hand's frame after which R_X turns by at most 120 degrees, or none where it
/// does already: P' grows without bound near 180. One of a quaternion's four components is at
/// least 1/2; a half turn about the right axis makes it the scalar part.
Eigen::Quaterniond turn_away_from_half_turn(const Eigen::Quaterniond& eye_from_hand) {
  if (std::abs(eye_from_hand.w()) >= 0.5) return Eigen::Quaterniond::Identity();
  Eigen::Index largest = 0;
  eye_from_hand.vec().cwiseAbs().maxCoeff(&largest);
  Eigen::Quaterniond half_turn(0, 0, 0, 0);
  half_turn.vec()[largest] = 1.0;
  return half_turn;
}

std::optional<Eigen::Matrix3d> rotation_by_gibbs_vector(std::span<const Movement> movements) {
  const auto about = eye_from_hand_rotation(movements);
  if (!about) return std::nullopt;
  const Eigen::Quaterniond q_about(*about);
  const Eigen::Quaterniond turned_from_hand = turn_away_from_half_turn(q_about);
  const auto n = static_cast<Eigen::Index>(movements.size());
  Eigen::MatrixXd matrix(3 * n, 3);
  Eigen::VectorXd right(3 * n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto [hand, eye] = signed_quaternions(movements[static_cast<std::size_t>(k)], q_about);
    const Eigen::Vector3d p_hand = 2.0 * (turned_from_hand * hand.vec());
    const Eigen::Vector3d p_eye = 2.0 * eye.vec();
    matrix.middleRows<3>(3 * k) = skew(p_eye + p_hand);
    right.segment<3>(3 * k) = p_hand - p_eye;
  }
  const auto gibbs = least_squares(matrix, right);
  if (!gibbs) return std::nullopt;
  Eigen::Quaterniond eye_from_turned(1, (*gibbs)[0], (*gibbs)[1], (*gibbs)[2]);
  return (eye_from_turned.normalized() * turned_from_hand).toRotationMatrix();
}

}  // namespace

std::optional<HandEyeSolution> tsai_lenz(const HandEyeProblem& problem) {
  return rotation_then_translation(problem, rotation_by_gibbs_vector);
}

}  // namespace handeye
