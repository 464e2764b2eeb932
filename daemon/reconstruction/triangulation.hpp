// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "daemon/geometry/pose.hpp"

namespace handeye {

/// A ray of a camera whose pose is known.
struct PosedRay {
  const Pose* eye_from_scene{nullptr};
  Eigen::Vector2d ray;  ///< undistorted (x/z, y/z)
};

/// The point nearest to all rays in the images (normalised coordinates): the midpoint of the rays
/// as start, then Gauss-Newton. Nothing where it is behind a camera or the rays are parallel.
std::optional<Eigen::Vector3d> triangulate(std::span<const PosedRay> rays);

/// Largest angle [rad] under which two of the cameras see the point (against the first and the
/// last: cameras move steadily, so these bound it closely at a linear cost).
double triangulation_angle_rad(std::span<const PosedRay> rays, const Eigen::Vector3d& point_scene);

}  // namespace handeye
