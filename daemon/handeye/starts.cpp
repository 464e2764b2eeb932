// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/starts.hpp"

#include <array>

#include <Eigen/Dense>

#include "daemon/handeye/linear_parts.hpp"
#include "daemon/handeye/methods/methods.hpp"
#include "daemon/handeye/movements.hpp"

namespace handeye {
namespace {

// Of the ratio of the paths: where hand and eye turn about one point, theirs is that of the
// distances to it, and the scale may be off by as much.
constexpr std::array<double, 3> kScales{1.0, 0.25, 4.0};

/// t_X of (I - R_E) t_X = t_E / s - R_X t_H for a given s: least squares of least length.
Eigen::Vector3d translation_for_scale(std::span<const Movement> movements,
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

HandEyeSolution for_scale(const NormalisedMovements& normalised, const Eigen::Matrix3d& rotation,
                          double scale) {
  Pose eye_from_hand = Pose::Identity();
  eye_from_hand.linear() = rotation;
  eye_from_hand.translation() = translation_for_scale(normalised.movements, rotation, scale);
  return normalised.restore(eye_from_hand, scale);
}

}  // namespace

std::vector<HandEyeSolution> starting_solutions(std::span<const Movement> movements,
                                                ScaleMode scale) {
  std::vector<HandEyeSolution> starts;
  const auto normalised = normalise(movements, scale);
  if (!normalised) return starts;
  const auto rotation = eye_from_hand_rotation(normalised->movements);
  if (!rotation) return starts;
  if (scale == ScaleMode::kKnown) {
    starts.push_back(for_scale(*normalised, *rotation, 1.0));
    starts.back().scale_units_per_mm = 1.0;  // free of rounding
    return starts;
  }
  // In normalised units both paths have the same length: their ratio is 1.
  for (const double of_ratio : kScales) {
    starts.push_back(for_scale(*normalised, *rotation, of_ratio));
  }
  for (const Solver solve : {dq_scale_separate, andreff}) {
    if (const auto solution = solve({.poses = {}, .movements = movements})) {
      starts.push_back(*solution);
    }
  }
  return starts;
}

}  // namespace handeye
