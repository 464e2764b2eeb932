// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/highlights.hpp"

#include <algorithm>

namespace handeye {
namespace {

constexpr int kColumns = 320;  ///< cells across the image, or a few more
// In cells.
constexpr int kWidest = 15;  ///< a spot; what is wider is bright tissue
constexpr int kClipped = 3;  ///< side of the smallest area that counts as clipped
constexpr int kBeyond = 2;   ///< a spot's skirt is taken with it
constexpr int kMargin = kWidest;

// Grey levels.
constexpr int kSaturated = 250;
/// A spot is at least so bright, as a share of the image's brightest, within these bounds: where
/// exposure or black level keep the picture below 255, so are its highlights.
constexpr double kBrightShare = 0.85;
constexpr int kLowestBright = 200;
constexpr int kHighestBright = 235;
constexpr int kLeastContrast = 30;  ///< over its surroundings

/// A spot stands out from what is about it by half of what is missing there to saturation.
bool is_spot(int brightest, int surroundings, int bright) {
  const int contrast = std::max(kLeastContrast, (255 - surroundings) / 2);
  return (brightest >= bright) & (brightest - surroundings >= contrast);
}

void largest_of_lines(const cv::Mat& grey, int top, int bottom, std::uint8_t* largest) {
  std::copy_n(grey.ptr<std::uint8_t>(top), grey.cols, largest);
  for (int y = top + 1; y < bottom; ++y) {
    const auto* line = grey.ptr<std::uint8_t>(y);
    for (int x = 0; x < grey.cols; ++x) largest[x] = std::max(largest[x], line[x]);
  }
}

void largest_of_groups(const std::uint8_t* pixels, int size, int groups, std::uint8_t* largest) {
  for (int group = 0; group < groups; ++group, pixels += size) {
    std::uint8_t found = pixels[0];
    for (int k = 1; k < size; ++k) found = std::max(found, pixels[k]);
    largest[group] = found;
  }
}

std::uint8_t largest_of(const PaddedGrid& grid) {
  std::uint8_t largest = 0;
  for (int y = 0; y < grid.rows(); ++y) {
    const std::uint8_t* row = grid.row(y);
    for (int x = 0; x < grid.columns(); ++x) largest = std::max(largest, row[x]);
  }
  return largest;
}

/// A row of cells as a line of pixels.
void widen(const std::uint8_t* cells, int side, int columns, std::uint8_t* pixels) {
  for (int x = 0; x < columns; ++x, pixels += side) {
    for (int k = 0; k < side; ++k) pixels[k] = cells[x];
  }
}

/// A line of the field of view (empty: all) without the spots.
void take_away(const cv::Mat& field_of_view, int y, const std::uint8_t* spots, cv::Mat& usable) {
  auto* out = usable.ptr<std::uint8_t>(y);
  const int columns = usable.cols;
  if (field_of_view.empty()) {
    for (int x = 0; x < columns; ++x) out[x] = static_cast<std::uint8_t>(~spots[x]);
    return;
  }
  const auto* field = field_of_view.ptr<std::uint8_t>(y);
  for (int x = 0; x < columns; ++x) out[x] = static_cast<std::uint8_t>(field[x] & ~spots[x]);
}

}  // namespace

const cv::Mat& Highlights::usable(const cv::Mat& grey, const cv::Mat& field_of_view) {
  shrink(grey);
  if (!find()) return field_of_view;
  write(grey.size(), field_of_view);
  return usable_;
}

void Highlights::shrink(const cv::Mat& grey) {
  side_ = std::max(1, grey.cols / kColumns);
  const int columns = (grey.cols + side_ - 1) / side_;
  const int rows = (grey.rows + side_ - 1) / side_;
  for (PaddedGrid* grid : {&brightest_, &surroundings_, &clipped_, &spots_}) {
    grid->resize(columns, rows, kMargin);
  }
  line_.resize(static_cast<std::size_t>(columns * side_));
  for (int y = 0; y < rows; ++y) {
    const int top = y * side_;
    largest_of_lines(grey, top, std::min(top + side_, grey.rows), line_.data());
    std::fill(line_.begin() + grey.cols, line_.end(), std::uint8_t{0});
    largest_of_groups(line_.data(), side_, columns, brightest_.row(y));
  }
}

/// Marks the cells of highlights in spots_; false: there are none.
bool Highlights::find() {
  const int top = largest_of(brightest_);
  if (top < kLowestBright) return false;
  const int bright =
      std::clamp(static_cast<int>(kBrightShare * top), kLowestBright, kHighestBright);

  // Openings: what is left of the image without anything narrower than the square.
  brightest_.fill_margin();
  surroundings_ = brightest_;
  surroundings_.smallest_ahead(kWidest);
  surroundings_.largest_ahead(kWidest);
  clipped_ = brightest_;
  clipped_.smallest_ahead(kClipped);
  clipped_.largest_ahead(kClipped);

  std::uint8_t any = 0;
  for (int y = 0; y < spots_.rows(); ++y) {
    const std::uint8_t* here = brightest_.row(y);
    const std::uint8_t* about = surroundings_.row(y - kWidest + 1) - kWidest + 1;
    const std::uint8_t* clipped = clipped_.row(y - kClipped + 1) - kClipped + 1;
    std::uint8_t* spot = spots_.row(y);
    for (int x = 0; x < spots_.columns(); ++x) {
      const bool found = (clipped[x] >= kSaturated) | is_spot(here[x], about[x], bright);
      spot[x] = found ? 255 : 0;
      any |= spot[x];
    }
  }
  if (any == 0) return false;
  spots_.fill_margin();
  spots_.largest_ahead(2 * kBeyond + 1);
  return true;
}

void Highlights::write(cv::Size size, const cv::Mat& field_of_view) {
  usable_.create(size, CV_8UC1);
  for (int y = 0; y < spots_.rows(); ++y) {
    const std::uint8_t* spot = spots_.row(y - kBeyond) - kBeyond;
    widen(spot, side_, spots_.columns(), line_.data());
    for (int line = y * side_; line < std::min((y + 1) * side_, size.height); ++line) {
      take_away(field_of_view, line, line_.data(), usable_);
    }
  }
}

}  // namespace handeye
