// SPDX-License-Identifier: BSD-3-Clause
#include "tests/sequences/lens_error.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Geometry>

namespace handeye::sequences {

LensError lens_error(const CameraModel& truth, const CameraModel& estimate,
                     const cv::Mat& field_of_view) {
  constexpr int kSteps = 32;
  CameraModel same_pinhole = truth;
  same_pinhole.distortion = estimate.distortion;

  LensError error;
  error.focal_percent = 100.0 * std::max(std::abs(estimate.fx / truth.fx - 1.0),
                                         std::abs(estimate.fy / truth.fy - 1.0));
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const Eigen::Vector2d pixel((truth.width - 1) * static_cast<double>(j) / kSteps,
                                  (truth.height - 1) * static_cast<double>(i) / kSteps);
      const cv::Point nearest(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
      if (!field_of_view.empty() && field_of_view.at<std::uint8_t>(nearest) == 0) continue;
      const auto ray = unproject(truth, pixel);
      if (!ray) continue;
      const auto distance_px = [&](const CameraModel& camera) {
        return (project<double>(camera, ray->homogeneous()) - pixel).norm();
      };
      error.ray_px = std::max(error.ray_px, distance_px(estimate));
      error.distortion_px = std::max(error.distortion_px, distance_px(same_pinhole));
    }
  }
  return error;
}

}  // namespace handeye::sequences
