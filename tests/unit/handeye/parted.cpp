// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/handeye/parted.hpp"

#include "tests/unit/handeye/draw.hpp"

namespace handeye::synthetic {
namespace {

Pose random_pose(Draw& draw) {
  Pose pose = Pose::Identity();
  pose.linear() = exp_so3(draw.normal3());
  pose.translation() = 200 * draw.normal3();
  return pose;
}

}  // namespace

PartedRecording in_parts(std::span<const HandEyeObservation> observations, const Truth& truth,
                         const std::vector<std::size_t>& lengths, const std::vector<double>& scales,
                         std::uint32_t seed) {
  Draw draw(seed);
  PartedRecording result;
  std::size_t next = 0;
  for (std::size_t p = 0; p < lengths.size(); ++p) {
    const Pose scene_from_own = random_pose(draw);
    result.parts.push_back({lengths[p], scales[p], truth.room_from_scene * scene_from_own});
    for (std::size_t k = 0; k < lengths[p]; ++k) {
      HandEyeObservation observation = observations[next++];
      Pose& eye = observation.poses.eye_from_scene;
      eye.translation() /= truth.solution.scale_units_per_mm;
      eye = eye * scene_from_own;
      eye.translation() *= scales[p];
      observation.part = static_cast<int>(p);
      result.observations.push_back(observation);
    }
  }
  return result;
}

std::vector<HandEyeObservation> only(std::span<const HandEyeObservation> observations, int part) {
  std::vector<HandEyeObservation> result;
  for (const HandEyeObservation& observation : observations) {
    if (observation.part == part) result.push_back(observation);
  }
  return result;
}

void slip(std::vector<HandEyeObservation>& observations, int part,
          const Eigen::Vector3d& rotation_rad) {
  Pose turn = Pose::Identity();
  turn.linear() = exp_so3(rotation_rad);
  for (HandEyeObservation& observation : observations) {
    if (observation.part != part) continue;
    observation.poses.eye_from_scene = turn * observation.poses.eye_from_scene;
  }
}

}  // namespace handeye::synthetic
