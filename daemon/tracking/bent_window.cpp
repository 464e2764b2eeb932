// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/bent_window.hpp"

#include <cstddef>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "daemon/geometry/projection.hpp"

namespace handeye {
namespace {

/// Four points that far from the middle, on the axes, have the second moment that a window's
/// texture has: 22 px^2 along an axis, half of what all pixels have, (23^2 - 1) / 12, for windows
/// are taken around corners. Measured on rendered tissue: 20 to 22 leave no bias, 44 one of the
/// other sign.
constexpr double kReach_px = 6.6;
/// Where a lens shrinks areas to less than this, of those in its middle, its model is near where it
/// folds over and says nothing any more.
constexpr double kLeastArea = 0.1;

Eigen::Vector2d seen(const CameraModel& lens, const Eigen::Vector2d& ray) {
  return project<double>(lens, Eigen::Vector3d(ray.homogeneous()));
}

/// A ray and how its pixel moves with it; nothing where the lens does not reach.
struct Sight {
  Eigen::Vector2d ray;
  Eigen::Matrix2d pixel_by_ray;
};

std::optional<Sight> sight_of(const CameraModel& lens, const Eigen::Vector2d& pixel) {
  const auto ray = unproject(lens, pixel);
  if (!ray) return std::nullopt;
  const Eigen::Matrix2d pixel_by_ray =
      project_with_derivative(lens, ray->homogeneous()).by_point_eye.leftCols<2>();
  if (!(pixel_by_ray.determinant() > kLeastArea * lens.fx * lens.fy)) return std::nullopt;
  return Sight{*ray, pixel_by_ray};
}

}  // namespace

CameraModel halved(CameraModel lens, int halvings) {
  const double scale = 1.0 / (1 << halvings);
  lens.width >>= halvings;
  lens.height >>= halvings;
  lens.fx *= scale;
  lens.fy *= scale;
  lens.cx = scale * (lens.cx + 0.5) - 0.5;
  lens.cy = scale * (lens.cy + 0.5) - 0.5;
  return lens;
}

std::optional<WindowRays> window_rays(const CameraModel& lens, const Eigen::Vector2d& middle_px) {
  const auto middle = sight_of(lens, middle_px);
  if (!middle) return std::nullopt;
  WindowRays rays{middle->ray, {}, middle->pixel_by_ray};
  const std::array<Eigen::Vector2d, 4> offsets{
      {{-kReach_px, 0}, {kReach_px, 0}, {0, -kReach_px}, {0, kReach_px}}};
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    const auto ray = unproject(lens, middle_px + offsets[i]);
    if (!ray) return std::nullopt;
    rays.around[i] = *ray;
  }
  return rays;
}

Eigen::Vector2d bend_px(const CameraModel& lens, const WindowRays& taken, const AffineWarp& found) {
  const auto middle = sight_of(lens, found.centre.cast<double>());
  if (!middle) return Eigen::Vector2d::Zero();
  // What the affine change of the window means for its rays.
  const Eigen::Matrix2d ray_change =
      middle->pixel_by_ray.inverse() * found.linear.cast<double>() * taken.pixel_by_ray;
  const Eigen::Vector2d middle_px = seen(lens, middle->ray);
  Eigen::Vector2d mean_px = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& ray : taken.around) {
    mean_px += seen(lens, middle->ray + ray_change * (ray - taken.middle)) - middle_px;
  }
  return mean_px / 4.0;
}

}  // namespace handeye
