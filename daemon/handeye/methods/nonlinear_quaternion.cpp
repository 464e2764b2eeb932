// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/methods/given_scale.hpp"
#include "daemon/handeye/methods/methods.hpp"
#include "daemon/handeye/methods/quaternion_objective.hpp"

namespace handeye {

std::optional<HandEyeSolution> nonlinear_quaternion(const HandEyeProblem& problem) {
  const auto start = dq_scale_separate(problem);
  if (!start) return std::nullopt;
  const auto metric = metric_movements(problem.movements, start->scale_units_per_mm);
  const Pose eye_from_hand = start->hand_from_eye.inverse();
  const Eigen::Quaterniond q(eye_from_hand.linear());

  const auto found = QuaternionObjective(metric, q).minimise({q, eye_from_hand.translation(), 1.0});
  if (!found) return std::nullopt;
  const double scale = found->s * start->scale_units_per_mm;
  return finish_by_dual_quaternions(problem.movements, scale,
                                    found->q.normalized().toRotationMatrix());
}

}  // namespace handeye
