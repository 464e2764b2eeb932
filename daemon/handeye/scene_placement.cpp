// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/scene_placement.hpp"

#include <algorithm>
#include <vector>

namespace handeye {
namespace {

constexpr int kMedianRounds = 5;

/// Component by component.
Eigen::Vector3d median(const std::vector<Eigen::Vector3d>& vectors) {
  Eigen::Vector3d result;
  std::vector<double> values(vectors.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < vectors.size(); ++k) values[k] = vectors[k][axis];
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    result[axis] = *middle;
  }
  return result;
}

}  // namespace

void place_scene(std::span<const CentredPose> poses, PoseUnknowns& unknowns) {
  std::vector<Eigen::Quaterniond> rotations;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const CentredPose& pose : poses) {
    rotations.push_back(pose.room_from_hand * unknowns.hand_from_eye *
                        pose.scene_from_eye.conjugate());
    sum += rotations.back().toRotationMatrix();
  }
  Eigen::Quaterniond& rotation = unknowns.room_from_scene;
  rotation = Eigen::Quaterniond(nearest_rotation(sum));
  std::vector<Eigen::Vector3d> differences(poses.size());
  for (int round = 0; round < kMedianRounds; ++round) {
    for (std::size_t k = 0; k < poses.size(); ++k) {
      differences[k] = log_so3((rotation.conjugate() * rotations[k]).toRotationMatrix());
    }
    rotation = (rotation * Eigen::Quaterniond(exp_so3(median(differences)))).normalized();
  }
  for (std::size_t k = 0; k < poses.size(); ++k) {
    differences[k] = poses[k].hand_in_room_mm + poses[k].room_from_hand * unknowns.eye_in_hand_mm -
                     rotation * poses[k].eye_in_scene_mm;
  }
  unknowns.scene_in_room_mm = median(differences);
}

}  // namespace handeye
