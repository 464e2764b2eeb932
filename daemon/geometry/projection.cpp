// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/geometry/projection.hpp"

namespace handeye {

Projection project_with_derivative(const CameraModel& camera, const Eigen::Vector3d& point_eye) {
  const auto& [k1, k2, p1, p2, k3] = camera.distortion;
  const double inverse_z = 1.0 / point_eye.z();
  const double x = point_eye.x() * inverse_z;
  const double y = point_eye.y() * inverse_z;
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double radial_by_r2 = k1 + r2 * (2.0 * k2 + 3.0 * r2 * k3);

  Projection projection;
  projection.pixel.x() =
      camera.fx * (x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x)) + camera.cx;
  projection.pixel.y() =
      camera.fy * (y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y) + camera.cy;

  const double dx_dx = radial + 2.0 * x * x * radial_by_r2 + 2.0 * p1 * y + 6.0 * p2 * x;
  const double mixed = 2.0 * x * y * radial_by_r2 + 2.0 * p1 * x + 2.0 * p2 * y;
  const double dy_dy = radial + 2.0 * y * y * radial_by_r2 + 6.0 * p1 * y + 2.0 * p2 * x;
  projection.by_point_eye << dx_dx, mixed, -(dx_dx * x + mixed * y),  //
      mixed, dy_dy, -(mixed * x + dy_dy * y);
  projection.by_point_eye.row(0) *= camera.fx * inverse_z;
  projection.by_point_eye.row(1) *= camera.fy * inverse_z;
  return projection;
}

Eigen::Matrix<double, 2, kLensParameters> pixel_by_lens(const CameraModel& camera,
                                                        const Eigen::Vector3d& point_eye) {
  const Eigen::Vector2d ray = point_eye.head<2>() / point_eye.z();
  const Eigen::Vector2d distorted = distort<double>(camera.distortion, ray);
  const Eigen::Vector2d focal(camera.fx, camera.fy);
  const double focal_mean = focal.mean();
  const double r2 = ray.squaredNorm();
  Eigen::Matrix<double, 2, kLensParameters> by_lens;
  by_lens.col(kFocal) = focal.cwiseProduct(distorted) / focal_mean;
  by_lens.col(kAspect) = focal_mean * Eigen::Vector2d(-distorted.x(), distorted.y());
  by_lens.col(kCentreX) = Eigen::Vector2d::UnitX();
  by_lens.col(kCentreY) = Eigen::Vector2d::UnitY();
  by_lens.col(kK1) = r2 * focal.cwiseProduct(ray);
  by_lens.col(kK2) = r2 * by_lens.col(kK1);
  return by_lens;
}

}  // namespace handeye
