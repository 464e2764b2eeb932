// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/dual_quaternion.hpp"
#include "daemon/handeye/linear_parts.hpp"
#include "daemon/handeye/methods/methods.hpp"
#include "daemon/handeye/movements.hpp"

namespace handeye {

std::optional<HandEyeSolution> dq_scale_separate(const HandEyeProblem& problem) {
  const auto normalised = normalise(problem.movements);
  if (!normalised) return std::nullopt;
  const auto rotation = eye_from_hand_rotation(normalised->movements);
  if (!rotation) return std::nullopt;
  const auto scale = scale_and_translation(normalised->movements, *rotation);
  if (!scale) return std::nullopt;

  std::vector<Movement> metric = normalised->movements;
  for (Movement& movement : metric) {
    movement.eye_j_from_eye_i.translation() /= scale->scale_units_per_mm;
  }
  const auto eye_from_hand = eye_from_hand_by_dual_quaternions(metric, *rotation);
  if (!eye_from_hand) return std::nullopt;
  return normalised->restore(*eye_from_hand, scale->scale_units_per_mm);
}

}  // namespace handeye
