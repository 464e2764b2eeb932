// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace handeye {

/// The seed's lens (Chung, after Tsai): a pixel lies at x_d = (pixel - centre) * pixel_mm on the
/// sensor, and x_u = x_d (1 + k1 |x_d|^2) is where it would lie without distortion. This k1
/// undistorts, per mm^2; OpenCV's distorts, in normalised coordinates: opposite sign, another unit.
struct SensorLens {
  Eigen::Vector2d pixel_mm{1.0, 1.0};  ///< width and height of a pixel on the sensor
  Eigen::Vector2d centre_px{0.0, 0.0};
  double k1_per_mm2{0.0};
};

/// Where a pixel lies on the sensor, from the image centre [mm].
Eigen::Vector2d sensor_mm(const SensorLens& lens, const Eigen::Vector2d& pixel);

/// Where it would lie without distortion [mm].
Eigen::Vector2d undistorted_mm(const SensorLens& lens, const Eigen::Vector2d& pixel);

/// r_d with r_u = r_d (1 + k1 r_d^2), the branch through zero. Where a barrel (k1 < 0) ends, so
/// that no r_d gives r_u, the largest r_d there is.
double distorted_radius(double k1_per_mm2, double undistorted_radius_mm);

/// Inverse of undistorted_mm, as far as distorted_radius goes.
Eigen::Vector2d distorted_pixel(const SensorLens& lens, const Eigen::Vector2d& undistorted_mm);

}  // namespace handeye
