// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Dense>

#include "daemon/handeye/linear_parts.hpp"
#include "daemon/handeye/methods/methods.hpp"
#include "daemon/handeye/methods/signed_quaternions.hpp"

// Chou, Kamel 1991, "Finding the position and orientation of a sensor on a robot manipulator using
// quaternions": q_E q - q q_H = G q = 0 for every movement. G has rank two; the singular value
// decomposition of the stacked G's leaves q as the right singular vector of the smallest singular
// value. With the signs of the quaternions in agreement this is the same least squares as that of
// horaud_closed_form, whose scalar parts add a multiple of the identity only: the two agree to
// rounding, and are both here because the literature has both.
namespace handeye {
namespace {

constexpr double kMinConditioning = 1e-9;  // third singular value to the first

std::optional<Eigen::Matrix3d> rotation_by_null_vector(std::span<const Movement> movements) {
  const auto about = eye_from_hand_rotation(movements);
  if (!about) return std::nullopt;
  const Eigen::Quaterniond q_about(*about);
  Eigen::MatrixXd stacked(4 * static_cast<Eigen::Index>(movements.size()), 4);
  for (std::size_t k = 0; k < movements.size(); ++k) {
    stacked.middleRows<4>(4 * static_cast<Eigen::Index>(k)) =
        rotation_rows(signed_quaternions(movements[k], q_about));
  }
  const auto [vectors, values] = right_singular(stacked);
  if (!(values[2] > kMinConditioning * values[0])) return std::nullopt;
  const Eigen::Vector4d q = vectors.col(3);
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

}  // namespace

std::optional<HandEyeSolution> chou_kamel(const HandEyeProblem& problem) {
  return rotation_then_translation(problem, rotation_by_null_vector);
}

}  // namespace handeye
