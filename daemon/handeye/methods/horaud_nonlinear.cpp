// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/methods/methods.hpp"
#include "daemon/handeye/methods/quaternion_objective.hpp"

namespace handeye {

std::optional<HandEyeSolution> horaud_nonlinear(const HandEyeProblem& problem) {
  const auto start = daniilidis(problem);
  if (!start) return std::nullopt;
  const auto hand_from_eye = horaud_hand_from_eye(problem.movements, start->hand_from_eye);
  if (!hand_from_eye) return std::nullopt;
  return HandEyeSolution{*hand_from_eye, 1.0};
}

}  // namespace handeye
