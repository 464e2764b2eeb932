// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/movements.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>

#include "daemon/handeye/usable.hpp"

namespace handeye {
namespace {

// Only what exact data lack is refused here; what noise hides is for the judge, who knows it.
constexpr double kMinRotation_rad = 1e-6;  // rms over the movements
constexpr double kMinAxisSpread = 1e-6;    // second principal rotation to the first

/// Whether one side of the movements does.
bool rotates_about_two_axes(std::span<const Movement> movements, Pose Movement::*side) {
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Movement& movement : movements) {
    const Eigen::Vector3d w = log_so3((movement.*side).linear());
    scatter += w * w.transpose() / static_cast<double>(movements.size());
  }
  const Eigen::Vector3d principal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter, Eigen::EigenvaluesOnly).eigenvalues();
  return principal[2] > kMinRotation_rad * kMinRotation_rad &&
         principal[1] > kMinAxisSpread * kMinAxisSpread * principal[2];
}

}  // namespace

Movement movement_between(const PosePair& i, const PosePair& j) {
  return {j.room_from_hand.inverse() * i.room_from_hand,
          j.eye_from_scene * i.eye_from_scene.inverse()};
}

HandEyeSolution NormalisedMovements::restore(const Pose& eye_from_hand,
                                             double normalised_scale) const {
  Pose in_mm = eye_from_hand;
  in_mm.translation() *= hand_mm;
  return {in_mm.inverse(), normalised_scale * eye_units / hand_mm};
}

std::optional<NormalisedMovements> normalise(std::span<const Movement> movements, ScaleMode scale) {
  if (movements.size() < 2) return std::nullopt;
  double hand_squares = 0;
  double eye_squares = 0;
  for (const auto& [hand, eye] : movements) {
    if (!is_usable(hand) || !is_usable(eye)) return std::nullopt;
    hand_squares += hand.translation().squaredNorm();
    eye_squares += eye.translation().squaredNorm();
  }
  if (!rotates_about_two_axes(movements, &Movement::hand_j_from_hand_i) ||
      !rotates_about_two_axes(movements, &Movement::eye_j_from_eye_i)) {
    return std::nullopt;
  }
  const auto n = static_cast<double>(movements.size());
  NormalisedMovements result{{movements.begin(), movements.end()},
                             std::sqrt(hand_squares / n),
                             std::sqrt(eye_squares / n)};
  if (scale == ScaleMode::kKnown) {
    // Both may turn about their own origins: then any unit will do.
    const double unit = std::sqrt(0.5 * (hand_squares + eye_squares) / n);
    result.hand_mm = result.eye_units = unit > 0 ? unit : 1.0;
  }
  if (!std::isnormal(result.hand_mm) || !std::isnormal(result.eye_units)) return std::nullopt;
  for (auto& [hand, eye] : result.movements) {
    hand.translation() /= result.hand_mm;
    eye.translation() /= result.eye_units;
  }
  return result;
}

}  // namespace handeye
