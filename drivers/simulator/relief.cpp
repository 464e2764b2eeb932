// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/relief.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/core.hpp>

#include "drivers/simulator/lattice_noise.hpp"

namespace handeye::simulator {
namespace {

/// Hills of about 100 mm with ever smaller ones on them.
constexpr FractalOptions kHills{.first_lattice = 8, .last_lattice = 64, .gain = 0.3};

/// Steepest slope of the bilinear surface in any direction: a cell's edges bound its inside.
double steepest_slope(const cv::Mat1f& heights, double cell_mm) {
  const int mask = heights.rows - 1;
  double steepest = 0;
  for (int row = 0; row <= mask; ++row) {
    for (int column = 0; column <= mask; ++column) {
      const float here = heights(row, column);
      const float right = heights(row, (column + 1) & mask) - here;
      const float down = heights((row + 1) & mask, column) - here;
      const float right_below =
          heights((row + 1) & mask, (column + 1) & mask) - heights((row + 1) & mask, column);
      const float down_right =
          heights((row + 1) & mask, (column + 1) & mask) - heights(row, (column + 1) & mask);
      const float along_x = std::max(std::abs(right), std::abs(right_below));
      const float along_y = std::max(std::abs(down), std::abs(down_right));
      steepest = std::max(steepest, std::hypot(along_x, along_y) / cell_mm);
    }
  }
  return steepest;
}

}  // namespace

Relief::Relief(std::uint64_t seed, const ReliefOptions& options)
    : mask_(options.nodes - 1),
      nodes_per_mm_(static_cast<float>(options.nodes / options.tile_mm)),
      half_tile_mm_(static_cast<float>(options.tile_mm / 2)) {
  RandomStream random(seed, Purpose::kRelief);
  const double cell_mm = options.tile_mm / options.nodes;
  cv::Mat1f heights = fractal_noise(kHills, options.nodes, random);

  double lowest = 0;
  double highest = 0;
  cv::minMaxLoc(heights, &lowest, &highest);
  const double scale = std::min(options.peak_to_peak_mm / (highest - lowest),
                                options.max_slope / steepest_slope(heights, cell_mm));
  heights = (heights - 0.5 * (lowest + highest)) * scale;
  slope_bound_ = steepest_slope(heights, cell_mm);
  highest_mm_ = 0.5 * (highest - lowest) * scale;
  lowest_mm_ = -highest_mm_;

  nodes_.reserve(heights.total());
  const auto per_two_cells = static_cast<float>(0.5 / cell_mm);
  for (int row = 0; row <= mask_; ++row) {
    for (int column = 0; column <= mask_; ++column) {
      const float slope_x =
          per_two_cells * (heights(row, (column + 1) & mask_) - heights(row, (column - 1) & mask_));
      const float slope_y =
          per_two_cells * (heights((row + 1) & mask_, column) - heights((row - 1) & mask_, column));
      nodes_.emplace_back(heights(row, column), slope_x, slope_y, 0.0F);
    }
  }
}

double Relief::height(double x_mm, double y_mm) const {
  const double u = (x_mm + half_tile_mm_) * nodes_per_mm_;
  const double v = (y_mm + half_tile_mm_) * nodes_per_mm_;
  const double column = std::floor(u);
  const double row = std::floor(v);
  const auto node = [this](double at_row, double at_column) {
    const auto r = static_cast<std::size_t>(static_cast<int>(at_row) & mask_);
    const auto c = static_cast<std::size_t>(static_cast<int>(at_column) & mask_);
    return static_cast<double>(nodes_[r * static_cast<std::size_t>(mask_ + 1) + c][0]);
  };
  const double top = std::lerp(node(row, column), node(row, column + 1), u - column);
  const double bottom = std::lerp(node(row + 1, column), node(row + 1, column + 1), u - column);
  return std::lerp(top, bottom, v - row);
}

std::optional<double> Relief::intersect(const Eigen::Vector3d& origin,
                                        const Eigen::Vector3d& direction, double limit) const {
  constexpr double kCloseEnoughMm = 1e-9;
  // How fast the gap between ray and surface can shrink along the ray.
  const double closing_speed = -direction.z() + slope_bound_ * direction.head<2>().norm();
  double along = 0;
  while (along <= limit) {
    const Eigen::Vector3d point = origin + along * direction;
    const double gap_mm = point.z() - height(point.x(), point.y());
    if (gap_mm < -kCloseEnoughMm) return std::nullopt;
    if (gap_mm < kCloseEnoughMm) return along;
    if (closing_speed <= 0) return std::nullopt;
    along += gap_mm / closing_speed;
  }
  return std::nullopt;
}

}  // namespace handeye::simulator
