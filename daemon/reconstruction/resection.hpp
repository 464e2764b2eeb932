// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/reconstruction/scene.hpp"

namespace handeye {

struct ResectionOptions {
  double max_reprojection_px{2.0};  ///< inliers lie within
  double robust_px{1.5};            ///< Huber loss of the last steps
  int min_inliers{15};
  double min_inlier_ratio{0.5};
};

/// A camera pose from known points.
struct Resection {
  Pose eye_from_scene{Pose::Identity()};
  int inliers{0};
  double reprojection_px{0};  ///< rms over the inliers
  /// As RegisteredFrame's; the inliers count by their weight.
  Matrix6d unit_covariance{Matrix6d::Zero()};
};

/// Robust least squares on the pose alone, from a predicted one; nothing when the matches do not
/// agree on a pose that near.
std::optional<Resection> refine_pose(const CameraModel& camera,
                                     const std::vector<PointMatch>& matches, const Pose& predicted,
                                     const ResectionOptions& options);

/// refine_pose; where that fails, P3P in RANSAC (no prediction needed) and refine_pose from there.
std::optional<Resection> resect(const CameraModel& camera, const std::vector<PointMatch>& matches,
                                const Pose& predicted, const ResectionOptions& options);

}  // namespace handeye
