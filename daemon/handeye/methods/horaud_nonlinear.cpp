// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/dual_quaternion.hpp"
#include "daemon/handeye/linear_parts.hpp"
#include "daemon/handeye/methods/methods.hpp"
#include "daemon/handeye/methods/quaternion_objective.hpp"

namespace handeye {

std::optional<HandEyeSolution> horaud_nonlinear(const HandEyeProblem& problem) {
  const auto rotation = eye_from_hand_rotation(problem.movements);
  if (!rotation) return std::nullopt;
  const auto start = eye_from_hand_by_dual_quaternions(problem.movements, *rotation);
  if (!start) return std::nullopt;
  const auto hand_from_eye = horaud_hand_from_eye(problem.movements, start->inverse());
  if (!hand_from_eye) return std::nullopt;
  return HandEyeSolution{*hand_from_eye, 1.0};
}

}  // namespace handeye
