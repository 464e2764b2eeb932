// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/parted_poses.hpp"

#include <cmath>

#include "daemon/handeye/scene_placement.hpp"

namespace handeye {
namespace {

CentredPose equation_pose(const HandEyeObservation& observation, double scale_units_per_mm) {
  const Pose& hand = observation.poses.room_from_hand;
  const Pose eye = observation.poses.eye_from_scene.inverse();
  return {Eigen::Quaterniond(hand.linear()).normalized(),
          hand.translation(),
          Eigen::Quaterniond(eye.linear()).normalized(),
          eye.translation() / scale_units_per_mm,
          observation.hand_angular_velocity,
          observation.hand_velocity};
}

}  // namespace

PartedPoses::PartedPoses(std::span<const HandEyeObservation> observations,
                         const HandEyeSolution& start, bool estimate_scale)
    : parts(parts_of(observations)),
      poses(observations.size()),
      scales_units_per_mm(parts.size(), start.scale_units_per_mm),
      scene_centres_mm(parts.size(), Eigen::Vector3d::Zero()) {
  const auto n = static_cast<double>(observations.size());
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const std::vector<std::size_t>& members = parts[p].members;
    if (p > 0 && estimate_scale) {
      scales_units_per_mm[p] = scale_of_path(poses_of(observations, parts[p]), start);
    }
    for (const std::size_t k : members) {
      poses[k] = equation_pose(observations[k], scales_units_per_mm[p]);
      room_centre_mm += poses[k].hand_in_room_mm / n;
      scene_centres_mm[p] += poses[k].eye_in_scene_mm / static_cast<double>(members.size());
    }
    for (const std::size_t k : members) poses[k].eye_in_scene_mm -= scene_centres_mm[p];
  }
  for (CentredPose& pose : poses) pose.hand_in_room_mm -= room_centre_mm;
}

PartedUnknowns PartedPoses::placed(const Pose& hand_from_eye) const {
  std::vector<PoseUnknowns> unknowns(parts.size());
  for (std::size_t p = 0; p < parts.size(); ++p) {
    unknowns[p].hand_from_eye = Eigen::Quaterniond(hand_from_eye.linear()).normalized();
    unknowns[p].eye_in_hand_mm = hand_from_eye.translation();
    std::vector<CentredPose> members;
    for (const std::size_t k : parts[p].members) members.push_back(poses[k]);
    place_scene(members, unknowns[p]);
  }
  return PartedUnknowns(std::move(unknowns));
}

Pose PartedPoses::room_from_scene(std::size_t part, const PoseUnknowns& unknowns) const {
  // The scene is scaled about its origin, not about the mean of the eyes.
  const Eigen::Vector3d centre_mm = scene_centres_mm[part] * std::exp(-unknowns.log_scale);
  return make_pose(unknowns.room_from_scene, unknowns.scene_in_room_mm + room_centre_mm -
                                                 unknowns.room_from_scene * centre_mm);
}

}  // namespace handeye
