// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/geometry/lens_parameters.hpp"

namespace handeye {

/// A pixel and how it moves with the point.
struct Projection {
  Eigen::Vector2d pixel;
  Eigen::Matrix<double, 2, 3> by_point_eye;  ///< d pixel / d point in eye coordinates
};

/// `project` with its derivative, written out: the adjustments spend most of their time here.
/// Only valid for z > 0: the caller checks.
Projection project_with_derivative(const CameraModel& camera, const Eigen::Vector3d& point_eye);

/// How a pixel moves with the lens that sees a point; columns as in LensParameter. Only valid for
/// z > 0: the caller checks.
Eigen::Matrix<double, 2, kLensParameters> pixel_by_lens(const CameraModel& camera,
                                                        const Eigen::Vector3d& point_eye);

/// Mean focal length [px], to express angles in px.
inline double focal_px(const CameraModel& camera) {
  return 0.5 * (camera.fx + camera.fy);
}

/// Thresholds on movement are given in px of a camera with this focal length, so that they mean the
/// same angle in every camera.
inline constexpr double kReferenceFocalPx = 600.0;

}  // namespace handeye
