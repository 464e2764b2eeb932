// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/blur.hpp"

#include <algorithm>

#include <opencv2/imgproc.hpp>

namespace handeye::simulator {
namespace {

constexpr int kInstants = 7;
constexpr int kSpacingPx = 16;

}  // namespace

void defocus(double sigma_px, cv::Mat1f& radiance) {
  if (sigma_px <= 0) return;
  cv::GaussianBlur(radiance, radiance, {}, sigma_px, sigma_px, cv::BORDER_REPLICATE);
}

MotionBlur::MotionBlur(const CameraModel& camera)
    : camera_(camera),
      coarse_px_((camera.height + kSpacingPx - 1) / kSpacingPx,
                 (camera.width + kSpacingPx - 1) / kSpacingPx),
      from_px_(camera.height, camera.width) {}

void MotionBlur::find_ways(const cv::Mat1f& depth_mm, const Pose& begin_from_middle,
                           const Pose& end_from_middle) {
  for (int i = 0; i < coarse_px_.rows; ++i) {
    for (int j = 0; j < coarse_px_.cols; ++j) {
      // The middles of the grid's cells, as cv::resize has them.
      const int row = std::min(i * kSpacingPx + kSpacingPx / 2, camera_.height - 1);
      const int column = std::min(j * kSpacingPx + kSpacingPx / 2, camera_.width - 1);
      const Eigen::Vector2d ray = unproject(camera_, Eigen::Vector2d(column, row)).value();
      const Eigen::Vector3d point = static_cast<double>(depth_mm(row, column)) * ray.homogeneous();
      const Eigen::Vector2d way = project<double>(camera_, end_from_middle * point) -
                                  project<double>(camera_, begin_from_middle * point);
      coarse_px_(i, j) = {static_cast<float>(way.x()), static_cast<float>(way.y())};
    }
  }
  cv::resize(coarse_px_, way_px_, {coarse_px_.cols * kSpacingPx, coarse_px_.rows * kSpacingPx}, 0,
             0, cv::INTER_LINEAR);
}

void MotionBlur::apply(const cv::Mat1f& depth_mm, const Pose& begin_from_middle,
                       const Pose& end_from_middle, cv::Mat1f& radiance) {
  find_ways(depth_mm, begin_from_middle, end_from_middle);
  sum_.create(radiance.size());
  sum_ = 0;
  for (int instant = 0; instant < kInstants; ++instant) {
    const float along = (static_cast<float>(instant) + 0.5F) / kInstants - 0.5F;
    for (int row = 0; row < radiance.rows; ++row) {
      for (int column = 0; column < radiance.cols; ++column) {
        const cv::Vec2f& way = way_px_(row, column);
        from_px_(row, column) = {static_cast<float>(column) - along * way[0],
                                 static_cast<float>(row) - along * way[1]};
      }
    }
    cv::remap(radiance, moved_, from_px_, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
    sum_ += moved_;
  }
  radiance = sum_ / kInstants;
}

}  // namespace handeye::simulator
