// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/dual_quaternion.hpp"
#include "daemon/handeye/linear_parts.hpp"
#include "daemon/handeye/methods/methods.hpp"
#include "daemon/handeye/movements.hpp"

namespace handeye {

std::optional<HandEyeSolution> daniilidis(const HandEyeProblem& problem) {
  const auto normalised = normalise(problem.movements, ScaleMode::kKnown);
  if (!normalised) return std::nullopt;
  const auto rotation = eye_from_hand_rotation(normalised->movements);
  if (!rotation) return std::nullopt;
  const auto eye_from_hand = eye_from_hand_by_dual_quaternions(normalised->movements, *rotation);
  if (!eye_from_hand) return std::nullopt;
  return normalised->restore(*eye_from_hand, 1.0);
}

}  // namespace handeye
