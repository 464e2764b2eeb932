// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/explained.hpp"

#include <algorithm>

#include "daemon/geometry/median.hpp"
#include "daemon/handeye/linear_parts.hpp"
#include "daemon/handeye/pairing.hpp"

namespace handeye {
namespace {

constexpr std::size_t kMaxMovements = 400;
constexpr double kMedianNorm = 1.538;  // of three normal variables of sigma 1
constexpr double kMinSigma = 1e-7;     // rounding; relative to the lengths for positions

std::optional<HandEyeSolution> linear_solution(std::span<const PosePair> poses,
                                               const std::vector<std::size_t>& right,
                                               ScaleMode scale) {
  std::vector<Movement> movements;
  for (const auto& [a, b] : spread_pairs(right.size(), 2 * kMaxMovements / right.size())) {
    movements.push_back(movement_between(poses[right[a]], poses[right[b]]));
  }
  const auto rotation = eye_from_hand_rotation(movements);
  if (!rotation) return std::nullopt;
  HandEyeSolution solution;
  Pose eye_from_hand = Pose::Identity();
  eye_from_hand.linear() = *rotation;
  if (scale == ScaleMode::kKnown) {
    const auto translation = translation_of(movements, *rotation);
    if (!translation) return std::nullopt;
    eye_from_hand.translation() = *translation;
  } else {
    const auto both = scale_and_translation(movements, *rotation);
    if (!both) return std::nullopt;
    solution.scale_units_per_mm = both->scale_units_per_mm;
    eye_from_hand.translation() = both->translation_scene / both->scale_units_per_mm;
  }
  solution.hand_from_eye = eye_from_hand.inverse();
  return solution;
}

double median_of(const std::vector<double>& values, const std::vector<std::size_t>& chosen) {
  std::vector<double> those;
  those.reserve(chosen.size());
  for (const std::size_t i : chosen) those.push_back(values[i]);
  return median(std::move(those));
}

/// The camera in the room, and room_from_scene, as one pose says: all say the same of the latter.
struct Claim {
  Eigen::Vector3d camera_by_hand_mm{Eigen::Vector3d::Zero()};  ///< in the room
  Eigen::Vector3d camera_by_eye_mm{Eigen::Vector3d::Zero()};   ///< in the scene
  Eigen::Matrix3d room_from_scene{Eigen::Matrix3d::Identity()};
};

Claim claim_of(const PosePair& pair, const HandEyeSolution& solution) {
  const Pose room_from_eye = pair.room_from_hand * solution.hand_from_eye;
  return {room_from_eye.translation(),
          pair.eye_from_scene.inverse().translation() / solution.scale_units_per_mm,
          room_from_eye.linear() * pair.eye_from_scene.linear()};
}

}  // namespace

std::optional<std::vector<bool>> explained_poses(std::span<const PosePair> poses,
                                                 const std::vector<bool>& right, ScaleMode scale,
                                                 double tolerance) {
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (right[i]) chosen.push_back(i);
  }
  if (chosen.size() < 3) return std::nullopt;
  const auto solution = linear_solution(poses, chosen, scale);
  if (!solution) return std::nullopt;

  std::vector<Claim> claims;
  claims.reserve(poses.size());
  for (const PosePair& pair : poses) claims.push_back(claim_of(pair, *solution));
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const std::size_t i : chosen) sum += claims[i].room_from_scene;
  const Eigen::Matrix3d room_from_scene = nearest_rotation(sum);

  std::vector<double> turns(poses.size());
  std::vector<Eigen::Vector3d> origins(poses.size());  // of the scene in the room
  for (std::size_t i = 0; i < poses.size(); ++i) {
    turns[i] = rotation_angle_rad(room_from_scene, claims[i].room_from_scene);
    origins[i] = claims[i].camera_by_hand_mm - room_from_scene * claims[i].camera_by_eye_mm;
  }
  Eigen::Vector3d origin;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> coordinates;
    for (const std::size_t i : chosen) coordinates.push_back(origins[i][axis]);
    origin[axis] = median(std::move(coordinates));
  }
  std::vector<double> shifts_mm(poses.size());
  std::vector<double> lengths_mm(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    shifts_mm[i] = (origins[i] - origin).norm();
    lengths_mm[i] = claims[i].camera_by_hand_mm.norm() + claims[i].camera_by_eye_mm.norm();
  }

  const double turn_sigma = std::max(kMinSigma, median_of(turns, chosen) / kMedianNorm);
  const double shift_sigma_mm = std::max(kMinSigma * median_of(lengths_mm, chosen),
                                         median_of(shifts_mm, chosen) / kMedianNorm);
  std::vector<bool> explained(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    explained[i] = turns[i] <= tolerance * turn_sigma && shifts_mm[i] <= tolerance * shift_sigma_mm;
  }
  return explained;
}

}  // namespace handeye
