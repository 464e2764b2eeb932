// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/geometry/camera_model.hpp"

#include <cmath>

#include <Eigen/Dense>

namespace handeye {
namespace {

/// Derivative of `distort` with respect to the normalised coordinates.
Eigen::Matrix2d distort_jacobian(const std::array<double, 5>& distortion,
                                 const Eigen::Vector2d& normalised) {
  const auto& [k1, k2, p1, p2, k3] = distortion;
  const double x = normalised.x();
  const double y = normalised.y();
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double radial_by_r2 = k1 + r2 * (2.0 * k2 + 3.0 * r2 * k3);
  Eigen::Matrix2d jacobian;
  jacobian(0, 0) = radial + 2.0 * x * x * radial_by_r2 + 2.0 * p1 * y + 6.0 * p2 * x;
  jacobian(0, 1) = 2.0 * x * y * radial_by_r2 + 2.0 * p1 * x + 2.0 * p2 * y;
  jacobian(1, 0) = jacobian(0, 1);
  jacobian(1, 1) = radial + 2.0 * y * y * radial_by_r2 + 6.0 * p1 * y + 2.0 * p2 * x;
  return jacobian;
}

}  // namespace

std::optional<std::string> CameraModel::problem() const {
  if (width < 1 || height < 1 || width > 16384 || height > 16384) {
    return "width and height must be 1 to 16384 px";
  }
  if (!std::isfinite(fx) || fx <= 0) return "fx must be a positive number";
  if (!std::isfinite(fy) || fy <= 0) return "fy must be a positive number";
  if (!std::isfinite(cx) || !std::isfinite(cy)) return "cx and cy must be numbers";
  for (const double coefficient : distortion) {
    if (!std::isfinite(coefficient)) return "distortion must hold numbers";
  }
  return std::nullopt;
}

std::optional<Eigen::Vector2d> unproject(const CameraModel& camera, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d distorted((pixel.x() - camera.cx) / camera.fx,
                                  (pixel.y() - camera.cy) / camera.fy);
  Eigen::Vector2d normalised = distorted;
  for (int iteration = 0; iteration < 20; ++iteration) {
    const Eigen::Vector2d error = distort<double>(camera.distortion, normalised) - distorted;
    const Eigen::Matrix2d jacobian = distort_jacobian(camera.distortion, normalised);
    // Beyond the radius where the distortion turns back on itself there is no unique ray.
    if (!(jacobian.determinant() > 1e-3)) return std::nullopt;
    const Eigen::Vector2d step = jacobian.inverse() * error;
    normalised -= step;
    if (step.squaredNorm() < 1e-24) return normalised;
  }
  return std::nullopt;
}

}  // namespace handeye
