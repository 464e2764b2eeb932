// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/methods/given_scale.hpp"

#include "daemon/handeye/dual_quaternion.hpp"
#include "daemon/handeye/movements.hpp"

namespace handeye {

std::vector<Movement> metric_movements(std::span<const Movement> movements,
                                       double scale_units_per_mm) {
  std::vector<Movement> metric(movements.begin(), movements.end());
  for (Movement& movement : metric) movement.eye_j_from_eye_i.translation() /= scale_units_per_mm;
  return metric;
}

std::optional<HandEyeSolution> finish_by_dual_quaternions(std::span<const Movement> movements,
                                                          double scale_units_per_mm,
                                                          const Eigen::Matrix3d& about) {
  const auto normalised = normalise(movements);
  if (!normalised) return std::nullopt;
  const double scale = scale_units_per_mm * normalised->hand_mm / normalised->eye_units;
  const auto eye_from_hand =
      eye_from_hand_by_dual_quaternions(metric_movements(normalised->movements, scale), about);
  if (!eye_from_hand) return std::nullopt;
  return normalised->restore(*eye_from_hand, scale);
}

}  // namespace handeye
