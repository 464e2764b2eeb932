// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "daemon/handeye/parted_unknowns.hpp"
#include "daemon/handeye/parts.hpp"

namespace handeye {

/// The poses as the likelihood's equations take them: scenes in mm by the scale that they start
/// from, room and scenes counted from the mean of their poses, which keeps the normal equations
/// well conditioned whatever the origins.
struct PartedPoses {
  /// The start's scale is the first part's; where it is estimated, the other parts start from that
  /// of their path.
  PartedPoses(std::span<const HandEyeObservation> observations, const HandEyeSolution& start,
              bool estimate_scale);

  /// The start's hand_from_eye, and where it places each part's scene.
  PartedUnknowns placed(const Pose& hand_from_eye) const;
  /// Scene in mm, from its own origin to the room's.
  Pose room_from_scene(std::size_t part, const PoseUnknowns& unknowns) const;

  std::vector<Part> parts;
  std::vector<CentredPose> poses;           ///< one an observation
  std::vector<double> scales_units_per_mm;  ///< one a part, as the centres
  Eigen::Vector3d room_centre_mm{Eigen::Vector3d::Zero()};
  std::vector<Eigen::Vector3d> scene_centres_mm;
};

}  // namespace handeye
