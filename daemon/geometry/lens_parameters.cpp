// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/geometry/lens_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "daemon/geometry/projection.hpp"

namespace handeye {
namespace {

/// Sensors of today have square pixels; calibrations differ from them by this much.
constexpr double kAspectSigma = 0.002;
/// Images are looked at on a grid of this many points along each side, the border included.
constexpr int kGrid = 13;

/// Calls `look` with the pixels of a grid over the image.
template <typename Look>
void for_grid(const CameraModel& camera, const Look& look) {
  for (int row = 0; row < kGrid; ++row) {
    for (int column = 0; column < kGrid; ++column) {
      look(Eigen::Vector2d((camera.width - 1.0) * column / (kGrid - 1),
                           (camera.height - 1.0) * row / (kGrid - 1)));
    }
  }
}

}  // namespace

LensVector lens_vector(const CameraModel& camera) {
  LensVector lens;
  lens << focal_px(camera), (camera.fy - camera.fx) / (camera.fy + camera.fx), camera.cx, camera.cy,
      camera.distortion[0], camera.distortion[1];
  return lens;
}

CameraModel with_lens(const CameraModel& camera, const LensVector& lens) {
  CameraModel result = camera;
  result.fx = lens[kFocal] * (1.0 - lens[kAspect]);
  result.fy = lens[kFocal] * (1.0 + lens[kAspect]);
  result.cx = lens[kCentreX];
  result.cy = lens[kCentreY];
  result.distortion[0] = lens[kK1];
  result.distortion[1] = lens[kK2];
  return result;
}

LensPrior lens_prior(const CameraModel& camera, IntrinsicsMode mode) {
  const double diagonal_px = std::hypot(camera.width, camera.height);
  LensPrior prior{.mean = lens_vector(camera)};
  if (mode == IntrinsicsMode::kRefine) {
    prior.sigma << 0.1 * prior.mean[kFocal], kAspectSigma, 0.025 * diagonal_px, 0.025 * diagonal_px,
        0.15, 0.15;
    return prior;
  }
  prior.mean << prior.mean[kFocal], 0.0, 0.5 * (camera.width - 1), 0.5 * (camera.height - 1), -0.1,
      0.0;
  prior.sigma << 0.5 * prior.mean[kFocal], kAspectSigma, 0.05 * diagonal_px, 0.05 * diagonal_px,
      0.25, 0.25;
  return prior;
}

CameraModel plain_camera(int width, int height, double horizontal_field_rad) {
  const double focal = 0.5 * width / std::tan(0.5 * horizontal_field_rad);
  return {width, height, focal, focal, 0.5 * (width - 1), 0.5 * (height - 1), {}};
}

double largest_difference_px(const CameraModel& first, const CameraModel& second) {
  double largest = 0.0;
  for_grid(first, [&](const Eigen::Vector2d& pixel) {
    const auto ray = unproject(first, pixel);
    if (!ray) return;
    const Eigen::Vector2d other = project<double>(second, Eigen::Vector3d(ray->x(), ray->y(), 1.0));
    largest = std::max(largest, (other - pixel).norm());
  });
  return largest;
}

double distortion_sigma_px(const CameraModel& camera, const LensMatrix& covariance,
                           const Eigen::Vector2d& ray) {
  const double r2 = ray.squaredNorm();
  const Eigen::Vector2d by_k(r2, r2 * r2);
  const double variance = by_k.dot(covariance.block<2, 2>(kK1, kK1) * by_k);
  return focal_px(camera) * ray.norm() * std::sqrt(std::max(0.0, variance));
}

}  // namespace handeye
