// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "daemon/sync/pose_buffer.hpp"

namespace handeye {

/// Where the hand has been while collecting, thinned to ten poses a second: how much it has moved
/// so far, and what to name its motion by.
class HandPath {
 public:
  /// Samples in order of time; hidden ones are skipped.
  void add(const HandSample& sample);

  std::span<const Pose> room_from_hand() const { return poses_; }
  /// Largest rotation against the first pose.
  double rotation_coverage_deg() const { return rotation_coverage_deg_; }
  /// Largest distance of the hand's origin from the first.
  double translation_coverage_mm() const { return translation_coverage_mm_; }
  /// Root mean square of the rotation about the axis that was turned about second most.
  double second_axis_deg() const;

 private:
  std::vector<Pose> poses_;
  std::int64_t last_kept_ns_{0};
  double rotation_coverage_deg_{0};
  double translation_coverage_mm_{0};
  Eigen::Matrix3d rotation_moment_{Eigen::Matrix3d::Zero()};  ///< sum of w w^T, w against the first
};

}  // namespace handeye
