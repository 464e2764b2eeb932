// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/perspective/lens.hpp"

#include <cmath>

namespace handeye {

Eigen::Vector2d sensor_mm(const SensorLens& lens, const Eigen::Vector2d& pixel) {
  return (pixel - lens.centre_px).cwiseProduct(lens.pixel_mm);
}

Eigen::Vector2d undistorted_mm(const SensorLens& lens, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d distorted = sensor_mm(lens, pixel);
  return distorted * (1.0 + lens.k1_per_mm2 * distorted.squaredNorm());
}

double distorted_radius(double k1_per_mm2, double undistorted_radius_mm) {
  const double k1 = k1_per_mm2;
  const double target = undistorted_radius_mm;
  if (k1 == 0.0 || target == 0.0) return target;
  double radius = target;
  if (k1 < 0.0) {
    // r (1 + k1 r^2) rises up to here and falls behind it.
    const double last = 1.0 / std::sqrt(-3.0 * k1);
    if (target >= last * (1.0 + k1 * last * last)) return last;
    radius = std::min(radius, last * (1.0 - 1e-6));
  }
  // Newton's method; the function is convex or concave between start and root, so it converges.
  constexpr int kIterations = 60;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const double value = radius * (1.0 + k1 * radius * radius) - target;
    const double step = value / (1.0 + 3.0 * k1 * radius * radius);
    radius -= step;
    if (std::abs(step) <= 1e-15 * std::abs(radius)) break;
  }
  return radius;
}

Eigen::Vector2d distorted_pixel(const SensorLens& lens, const Eigen::Vector2d& undistorted_mm) {
  const double radius = undistorted_mm.norm();
  const double ratio = radius > 0.0 ? distorted_radius(lens.k1_per_mm2, radius) / radius : 1.0;
  return (ratio * undistorted_mm).cwiseQuotient(lens.pixel_mm) + lens.centre_px;
}

}  // namespace handeye
