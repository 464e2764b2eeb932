// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/lk_corner_grid.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace handeye {
namespace {

constexpr int kBlockPx = 9;   ///< window of the structure tensor
constexpr int kMarginPx = 6;  ///< around a cell, so that its rim sees true gradients
constexpr int kBorderPx = 6;  ///< of the image, without corners
/// Highlights saturate and move with the light: perfect corners of nothing. A corner keeps away.
constexpr int kSaturated = 250;
constexpr int kHighlightPx = 6;

int cell_side(cv::Size image_size, int cells, double min_distance_px) {
  const double side = std::sqrt(static_cast<double>(image_size.area()) / std::max(1, cells));
  return std::max(static_cast<int>(std::lround(std::max(side, min_distance_px))), 8);
}

bool touches_highlight(const cv::Mat& grey, cv::Point2f pixel) {
  const cv::Rect around =
      cv::Rect(static_cast<int>(pixel.x) - kHighlightPx, static_cast<int>(pixel.y) - kHighlightPx,
               2 * kHighlightPx + 1, 2 * kHighlightPx + 1) &
      cv::Rect({0, 0}, grey.size());
  double brightest = 0;
  cv::minMaxLoc(grey(around), nullptr, &brightest);
  return brightest >= kSaturated;
}

}  // namespace

LkCornerGrid::LkCornerGrid(cv::Size image_size, int cells, double min_distance_px)
    : image_size_(image_size),
      min_distance_px_(min_distance_px),
      cell_px_(cell_side(image_size, cells, min_distance_px)),
      columns_((image_size.width + cell_px_ - 1) / cell_px_),
      rows_((image_size.height + cell_px_ - 1) / cell_px_),
      features_of_cell_(static_cast<std::size_t>(columns_ * rows_)) {}

void LkCornerGrid::detect(const cv::Mat& image, const cv::Mat& grey, const cv::Mat& usable,
                        const std::vector<cv::Point2f>& features, int max_cells,
                        std::vector<LkCorner>& corners) {
  corners.clear();
  occupy(features);
  int looked_at = 0;
  for (int step = 0; step < cell_count() && looked_at < max_cells; ++step) {
    const int cell = next_cell_;
    next_cell_ = (next_cell_ + 1) % cell_count();
    if (!features_of_cell_[static_cast<std::size_t>(cell)].empty()) continue;
    ++looked_at;
    LkCorner corner;
    if (!best_in_cell(image, usable, cell, corner) || touches_highlight(grey, corner.pixel))
      continue;
    corners.push_back(corner);
    features_of_cell_[static_cast<std::size_t>(cell)].push_back(corner.pixel);
  }
}

void LkCornerGrid::occupy(const std::vector<cv::Point2f>& features) {
  for (auto& cell : features_of_cell_) cell.clear();
  for (const cv::Point2f& feature : features) {
    const int column = std::clamp(static_cast<int>(feature.x) / cell_px_, 0, columns_ - 1);
    const int row = std::clamp(static_cast<int>(feature.y) / cell_px_, 0, rows_ - 1);
    features_of_cell_[index_of(row, column)].push_back(feature);
  }
}

bool LkCornerGrid::best_in_cell(const cv::Mat& image, const cv::Mat& usable, int cell,
                              LkCorner& corner) {
  const cv::Rect inside(kBorderPx, kBorderPx, image_size_.width - 2 * kBorderPx,
                        image_size_.height - 2 * kBorderPx);
  const cv::Rect area =
      cv::Rect((cell % columns_) * cell_px_, (cell / columns_) * cell_px_, cell_px_, cell_px_) &
      inside;
  if (area.empty()) return false;
  if (!usable.empty() && cv::countNonZero(usable(area)) == 0) return false;
  const cv::Rect wide = cv::Rect(area.x - kMarginPx, area.y - kMarginPx, area.width + 2 * kMarginPx,
                                 area.height + 2 * kMarginPx) &
                        cv::Rect({0, 0}, image_size_);
  cv::cornerMinEigenVal(image(wide), strength_, kBlockPx);
  corner.strength = 0;
  for (int y = area.y; y < area.br().y; ++y) {
    const float* strength = strength_.ptr<float>(y - wide.y);
    const std::uint8_t* allowed = usable.empty() ? nullptr : usable.ptr<std::uint8_t>(y);
    for (int x = area.x; x < area.br().x; ++x) {
      const float here = strength[x - wide.x];
      if (here <= corner.strength || (allowed != nullptr && allowed[x] == 0)) continue;
      const cv::Point2f pixel(static_cast<float>(x), static_cast<float>(y));
      if (!is_far_from_all(pixel, cell)) continue;
      corner = {pixel, here};
    }
  }
  return corner.strength > 0;
}

bool LkCornerGrid::is_far_from_all(cv::Point2f pixel, int cell) const {
  const double min_squared = min_distance_px_ * min_distance_px_;
  const int column = cell % columns_;
  const int row = cell / columns_;
  for (int r = std::max(0, row - 1); r <= std::min(rows_ - 1, row + 1); ++r) {
    for (int c = std::max(0, column - 1); c <= std::min(columns_ - 1, column + 1); ++c) {
      for (const cv::Point2f& other : features_of_cell_[index_of(r, c)]) {
        const cv::Point2f apart = other - pixel;
        if (apart.dot(apart) < min_squared) return false;
      }
    }
  }
  return true;
}

}  // namespace handeye
