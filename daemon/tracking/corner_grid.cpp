// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/corner_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "daemon/tracking/patch.hpp"

namespace handeye {
namespace {

constexpr int kRadius = 3;  ///< of the structure tensor's window, px of the half-size image
/// Highlights saturate and move with the light: perfect corners of nothing. A corner keeps away.
constexpr int kSaturated = 250 * static_cast<int>(ImagePyramid::kUnitsPerGrey);
constexpr int kPatchPx = Patch::kRadius + 1;  ///< derivatives reach one pixel farther

int cell_side(cv::Size image_size, int cells, double min_distance_px) {
  const double side = std::sqrt(static_cast<double>(image_size.area()) / std::max(1, cells));
  return std::max(static_cast<int>(std::lround(std::max(side, min_distance_px))), 8);
}

bool touches_highlight(const PaddedPlane<std::int16_t>& grey, int x, int y) {
  for (int row = y - kPatchPx; row <= y + kPatchPx; ++row) {
    const std::int16_t* pixels = grey.at(x - kPatchPx, row);
    for (int i = 0; i <= 2 * kPatchPx; ++i) {
      if (pixels[i] >= kSaturated) return true;
    }
  }
  return false;
}

}  // namespace

CornerGrid::CornerGrid(cv::Size image_size, int cells, double min_distance_px)
    : image_size_(image_size), fewest_cells_(cells), min_distance_px_(min_distance_px) {
  cut(std::numeric_limits<int>::max());
  most_cells_ = cell_count();
  entries_.reserve(2 * first_of_cell_.size());
  cut(cells);
  const auto side = static_cast<std::size_t>(cell_px_ / 2 + 2 + 2 * kRadius);
  products_.resize(side * side);
  row_sums_.resize(side * side);
  strength_.resize(side * side);
}

void CornerGrid::cut(int cells) {
  cell_px_ = cell_side(image_size_, std::max(cells, fewest_cells_), min_distance_px_);
  columns_ = (image_size_.width + cell_px_ - 1) / cell_px_;
  rows_ = (image_size_.height + cell_px_ - 1) / cell_px_;
  first_of_cell_.assign(index_of(rows_, 0), kNone);
  next_cell_ = 0;
}

void CornerGrid::detect(const ImagePyramid& pyramid, const std::vector<Eigen::Vector2f>& features,
                        int max_cells, std::vector<Corner>& corners) {
  corners.clear();
  occupy(features);
  int looked_at = 0;
  for (int step = 0; step < cell_count() && looked_at < max_cells; ++step) {
    const int cell = next_cell_;
    next_cell_ = (next_cell_ + 1) % cell_count();
    if (first_of_cell_[static_cast<std::size_t>(cell)] != kNone) continue;
    ++looked_at;
    Corner corner;
    if (!best_in_cell(pyramid, cell, corner)) continue;
    corners.push_back(corner);
    enter({static_cast<float>(corner.x), static_cast<float>(corner.y)});
  }
}

void CornerGrid::occupy(const std::vector<Eigen::Vector2f>& features) {
  std::fill(first_of_cell_.begin(), first_of_cell_.end(), kNone);
  entries_.clear();
  for (const Eigen::Vector2f& feature : features) enter(feature);
}

void CornerGrid::enter(const Eigen::Vector2f& feature) {
  const int column = std::clamp(static_cast<int>(feature.x()) / cell_px_, 0, columns_ - 1);
  const int row = std::clamp(static_cast<int>(feature.y()) / cell_px_, 0, rows_ - 1);
  std::size_t& first = first_of_cell_[index_of(row, column)];
  entries_.push_back({feature, first});
  first = entries_.size() - 1;
}

/// Fills strength_ for the pixels of a rectangle of the half-size image, row by row.
void CornerGrid::measure(const ImagePyramid& pyramid, cv::Rect half) {
  const PaddedPlane<std::int16_t>& grey = pyramid.grey(1);
  const std::ptrdiff_t stride = grey.stride();
  const int wide = half.width + 2 * kRadius;
  const int high = half.height + 2 * kRadius;
  for (int y = 0; y < high; ++y) {
    const std::int16_t* from = grey.at(half.x - kRadius, half.y - kRadius + y);
    Products* out = products_.data() + y * wide;
    for (int x = 0; x < wide; ++x) {
      const int dx = from[x + 1] - from[x - 1];
      const int dy = from[x + stride] - from[x - stride];
      out[x] = {dx * dx, dx * dy, dy * dy};
    }
    Products* sums = row_sums_.data() + y * half.width;
    Products sum{0, 0, 0};
    for (int x = 0; x < wide; ++x) {
      sum = {sum.xx + out[x].xx, sum.xy + out[x].xy, sum.yy + out[x].yy};
      if (x < 2 * kRadius) continue;
      sums[x - 2 * kRadius] = sum;
      const Products& gone = out[x - 2 * kRadius];
      sum = {sum.xx - gone.xx, sum.xy - gone.xy, sum.yy - gone.yy};
    }
  }
  // To (grey levels / px of level 0)^2: the differences span four px of level 0.
  constexpr float kPerPx = 1.0F / (4.0F * ImagePyramid::kUnitsPerGrey);
  constexpr float kWindow = (2 * kRadius + 1) * (2 * kRadius + 1);
  for (int x = 0; x < half.width; ++x) {
    Products sum{0, 0, 0};
    for (int y = 0; y < high; ++y) {
      const Products& next = row_sums_[static_cast<std::size_t>(y * half.width + x)];
      sum = {sum.xx + next.xx, sum.xy + next.xy, sum.yy + next.yy};
      if (y < 2 * kRadius) continue;
      const auto middle = 0.5F * (static_cast<float>(sum.xx) + static_cast<float>(sum.yy));
      const auto apart = 0.5F * (static_cast<float>(sum.xx) - static_cast<float>(sum.yy));
      const auto mixed = static_cast<float>(sum.xy);
      const float smaller = middle - std::sqrt(apart * apart + mixed * mixed);
      strength_[static_cast<std::size_t>((y - 2 * kRadius) * half.width + x)] =
          smaller * kPerPx * kPerPx / kWindow;
      const Products& gone =
          row_sums_[static_cast<std::size_t>((y - 2 * kRadius) * half.width + x)];
      sum = {sum.xx - gone.xx, sum.xy - gone.xy, sum.yy - gone.yy};
    }
  }
}

bool CornerGrid::best_in_cell(const ImagePyramid& pyramid, int cell, Corner& corner) {
  const cv::Rect inside(kPatchPx, kPatchPx, image_size_.width - 2 * kPatchPx,
                        image_size_.height - 2 * kPatchPx);
  const cv::Rect area =
      cv::Rect((cell % columns_) * cell_px_, (cell / columns_) * cell_px_, cell_px_, cell_px_) &
      inside;
  if (area.width < 2 || area.height < 2) return false;
  const cv::Point first((area.x + 1) / 2, (area.y + 1) / 2);
  const cv::Rect half(first.x, first.y, (area.br().x - 1) / 2 - first.x + 1,
                      (area.br().y - 1) / 2 - first.y + 1);
  measure(pyramid, half);
  corner.strength = 0;
  for (int y = 0; y < half.height; ++y) {
    for (int x = 0; x < half.width; ++x) {
      const float here = strength_[static_cast<std::size_t>(y * half.width + x)];
      if (here <= corner.strength) continue;
      const int at_x = 2 * (half.x + x);
      const int at_y = 2 * (half.y + y);
      if (!is_far_from_all(static_cast<float>(at_x), static_cast<float>(at_y), cell)) continue;
      if (!pyramid.all_usable(0, at_x - kPatchPx, at_y - kPatchPx, at_x + kPatchPx,
                              at_y + kPatchPx)) {
        continue;
      }
      if (touches_highlight(pyramid.grey(0), at_x, at_y)) continue;
      corner = {at_x, at_y, here};
    }
  }
  return corner.strength > 0;
}

bool CornerGrid::is_far_from_all(float x, float y, int cell) const {
  const auto min_squared = static_cast<float>(min_distance_px_ * min_distance_px_);
  const int column = cell % columns_;
  const int row = cell / columns_;
  for (int r = std::max(0, row - 1); r <= std::min(rows_ - 1, row + 1); ++r) {
    for (int c = std::max(0, column - 1); c <= std::min(columns_ - 1, column + 1); ++c) {
      for (std::size_t i = first_of_cell_[index_of(r, c)]; i != kNone; i = entries_[i].next) {
        if ((entries_[i].pixel - Eigen::Vector2f(x, y)).squaredNorm() < min_squared) return false;
      }
    }
  }
  return true;
}

}  // namespace handeye
