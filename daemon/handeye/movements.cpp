// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/movements.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>

namespace handeye {
namespace {

// Only what exact data lack is refused here; what noise hides is for the judge, who knows it.
constexpr double kRotationTolerance = 1e-6;  // of R^T R - I; poses from text files have as much
constexpr double kMinRotation_rad = 1e-6;    // rms over the movements
constexpr double kMinAxisSpread = 1e-6;      // second principal rotation to the first

bool is_rigid(const Pose& pose) {
  if (!pose.matrix().allFinite()) return false;
  const Eigen::Matrix3d& rotation = pose.linear();
  const Eigen::Matrix3d excess = rotation.transpose() * rotation - Eigen::Matrix3d::Identity();
  return excess.cwiseAbs().maxCoeff() <= kRotationTolerance && rotation.determinant() > 0;
}

bool rotates_about_two_axes(std::span<const Movement> movements) {
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Movement& movement : movements) {
    const Eigen::Vector3d w = log_so3(movement.hand_j_from_hand_i.linear());
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
    if (!is_rigid(hand) || !is_rigid(eye)) return std::nullopt;
    hand_squares += hand.translation().squaredNorm();
    eye_squares += eye.translation().squaredNorm();
  }
  if (!rotates_about_two_axes(movements)) return std::nullopt;
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
