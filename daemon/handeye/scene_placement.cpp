// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/scene_placement.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "daemon/geometry/median.hpp"
#include "daemon/handeye/pairing.hpp"

namespace handeye {
namespace {

constexpr int kMedianRounds = 5;
constexpr std::size_t kPathPartners = 20;  // that each pose is compared with

Eigen::Vector3d median_by_component(const std::vector<Eigen::Vector3d>& vectors) {
  Eigen::Vector3d result;
  std::vector<double> values(vectors.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < vectors.size(); ++k) values[k] = vectors[k][axis];
    result[axis] = median(values);
  }
  return result;
}

/// How far the camera went between two poses.
struct Distance {
  double room_mm{0};
  double scene_units{0};
};

}  // namespace

double scale_of_path(std::span<const PosePair> poses, const HandEyeSolution& start) {
  std::vector<Distance> distances;
  for (const auto& [i, j] : spread_pairs(poses.size(), kPathPartners)) {
    const auto in_room = [&](std::size_t k) -> Eigen::Vector3d {
      return poses[k].room_from_hand * start.hand_from_eye.translation();
    };
    const auto in_scene = [&](std::size_t k) -> Eigen::Vector3d {
      return poses[k].eye_from_scene.inverse().translation();
    };
    distances.push_back({(in_room(i) - in_room(j)).norm(), (in_scene(i) - in_scene(j)).norm()});
  }
  // Short ones are noise.
  const auto half = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), half, distances.end(),
                   [](const Distance& a, const Distance& b) { return a.room_mm > b.room_mm; });
  std::vector<double> ratios;
  for (auto distance = distances.begin(); distance != half; ++distance) {
    ratios.push_back(distance->scene_units / distance->room_mm);
  }
  if (ratios.empty()) return start.scale_units_per_mm;
  const double middle = median(std::move(ratios));
  return std::isnormal(middle) ? middle : start.scale_units_per_mm;
}

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
    rotation =
        (rotation * Eigen::Quaterniond(exp_so3(median_by_component(differences)))).normalized();
  }
  for (std::size_t k = 0; k < poses.size(); ++k) {
    differences[k] = poses[k].hand_in_room_mm + poses[k].room_from_hand * unknowns.eye_in_hand_mm -
                     rotation * poses[k].eye_in_scene_mm;
  }
  unknowns.scene_in_room_mm = median_by_component(differences);
}

}  // namespace handeye
