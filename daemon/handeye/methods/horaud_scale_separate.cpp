// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/methods/given_scale.hpp"
#include "daemon/handeye/methods/methods.hpp"
#include "daemon/handeye/methods/quaternion_objective.hpp"

namespace handeye {

std::optional<HandEyeSolution> horaud_scale_separate(const HandEyeProblem& problem) {
  // The scale of eqs 4 and 6, and the start, are those of dq_scale_separate.
  const auto linear = dq_scale_separate(problem);
  if (!linear) return std::nullopt;
  const auto metric = metric_movements(problem.movements, linear->scale_units_per_mm);
  const auto hand_from_eye = horaud_hand_from_eye(metric, linear->hand_from_eye);
  if (!hand_from_eye) return std::nullopt;
  return HandEyeSolution{*hand_from_eye, linear->scale_units_per_mm};
}

}  // namespace handeye
