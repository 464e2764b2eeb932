// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>

#include <Eigen/Core>

namespace handeye {

/// A pinhole camera with OpenCV's distortion, in OpenCV's order and signs (it distorts normalised
/// coordinates). Eye frame: x right, y down, z forward. Pixel centres at integers.
struct CameraModel {
  int width{0};                        ///< px
  int height{0};                       ///< px
  double fx{0}, fy{0}, cx{0}, cy{0};   ///< px
  std::array<double, 5> distortion{};  ///< k1, k2, p1, p2, k3

  /// Nothing when usable, else what is wrong, in words ("fx must be a positive number").
  std::optional<std::string> problem() const;
};

/// Distorts normalised coordinates (x/z, y/z). T: double or ceres::Jet.
template <typename T>
Eigen::Matrix<T, 2, 1> distort(const std::array<double, 5>& distortion,
                               const Eigen::Matrix<T, 2, 1>& normalised) {
  const auto& [k1, k2, p1, p2, k3] = distortion;
  const T& x = normalised.x();
  const T& y = normalised.y();
  const T r2 = x * x + y * y;
  const T radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
          y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
}

/// Pixel of a point in eye coordinates (any unit). Only valid for z > 0: the caller checks.
template <typename T>
Eigen::Matrix<T, 2, 1> project(const CameraModel& camera, const Eigen::Matrix<T, 3, 1>& point_eye) {
  const Eigen::Matrix<T, 2, 1> normalised(point_eye.x() / point_eye.z(),
                                          point_eye.y() / point_eye.z());
  const Eigen::Matrix<T, 2, 1> distorted = distort<T>(camera.distortion, normalised);
  return {camera.fx * distorted.x() + camera.cx, camera.fy * distorted.y() + camera.cy};
}

/// The ray (x/z, y/z) of a pixel: inverse of project by Newton's method. Nothing where the
/// distortion cannot be inverted (far outside the calibrated field).
std::optional<Eigen::Vector2d> unproject(const CameraModel& camera, const Eigen::Vector2d& pixel);

}  // namespace handeye
