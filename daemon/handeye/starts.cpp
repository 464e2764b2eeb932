// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/starts.hpp"

#include <Eigen/Dense>

#include "daemon/handeye/linear_parts.hpp"
#include "daemon/handeye/methods/methods.hpp"
#include "daemon/handeye/movements.hpp"
#include "daemon/handeye/selection.hpp"

namespace handeye {
namespace {

/// t_X of (I - R_E) t_X = t_E / s - R_X t_H for a given s: least squares of least length.
Eigen::Vector3d translation_for_scale(const std::vector<Movement>& movements,
                                      const Eigen::Matrix3d& rotation, double scale) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const auto& [hand, eye] : movements) {
    const Eigen::Matrix3d rows = Eigen::Matrix3d::Identity() - eye.linear();
    normal += rows.transpose() * rows;
    right += rows.transpose() * (eye.translation() / scale - rotation * hand.translation());
  }
  return normal.completeOrthogonalDecomposition().solve(right);
}

}  // namespace

std::vector<HandEyeSolution> starting_solutions(std::span<const PosePair> poses) {
  std::vector<HandEyeSolution> starts;
  const std::vector<Movement> movements = select_movements(poses).movements;
  for (const Solver solve : {dq_scale_separate, andreff}) {
    if (const auto solution = solve({.poses = poses, .movements = movements})) {
      starts.push_back(*solution);
    }
  }
  const auto normalised = normalise(movements);
  if (!normalised) return starts;
  const auto rotation = eye_from_hand_rotation(normalised->movements);
  if (!rotation) return starts;
  // In normalised units both paths have the same length: their ratio is 1.
  Pose eye_from_hand = Pose::Identity();
  eye_from_hand.linear() = *rotation;
  eye_from_hand.translation() = translation_for_scale(normalised->movements, *rotation, 1.0);
  starts.push_back(normalised->restore(eye_from_hand, 1.0));
  return starts;
}

}  // namespace handeye
