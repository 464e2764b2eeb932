// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/fields.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace handeye {
namespace {

constexpr int kLines = 64;       ///< odd lines looked at, or a few more
constexpr int kCellRows = 6;     ///< cells down the image
constexpr int kCellColumns = 8;  ///< and across
constexpr int kTogether =
    4;  ///< pixels of a line at VGA's width: wider movements are seen, noise not
constexpr int kTogetherWidth = 640;
/// A difference over so many grey levels is a rim or a highlight, not a texture that moves.
constexpr int kLargestStep = 48;
/// Cells of less contrast than this say nothing [grey levels, rms per pixel].
constexpr double kLeastContrast = 1.0;
constexpr std::size_t kFewestCells = 6;
/// A texture is fine enough to deceive if its steps agree less than this with wider ones (0.15: a
/// period of seven lines), unless it hardly changes down the image.
constexpr double kResolved = 0.15;
constexpr double kLevelTexture = 0.1;

constexpr double kClearlyExplained = 0.25;
constexpr double kClearMovement_px = 0.35;
// Clear images in excess of unclear ones that settle it: one or two may be an accident.
constexpr int kSettled = 3;
/// Then only so many images are looked at. Of a scope held still, or of three accidents, none is
/// clear any more; of one that moves now and then some are. Interlacing that was given up too early
/// is noticed again with the next movement, and until then nothing was combed.
constexpr int kLookedAtEvery = 4;
constexpr int kMostEvidence = 25;
constexpr int kClearCounts = 5;  ///< unclear ones

/// Sums of `together` pixels of a line.
void sum_pixels(const cv::Mat& grey, int y, int together, std::vector<int>& sums) {
  const auto* row = grey.ptr<std::uint8_t>(y);
  for (std::size_t i = 0; i < sums.size(); ++i, row += together) {
    int sum = 0;
    for (int k = 0; k < together; ++k) sum += row[k];
    sums[i] = sum;
  }
}

/// The line half way between b and c. Cubic: keeps more of the contrast than the mean of the two,
/// and is as symmetric.
void between(const std::uint8_t* a, const std::uint8_t* b, const std::uint8_t* c,
             const std::uint8_t* d, int columns, std::uint8_t* out) {
  for (int x = 0; x < columns; ++x) {
    const auto sixteenfold = static_cast<std::int16_t>(9 * (b[x] + c[x]) - (a[x] + d[x]) + 8);
    const auto value = static_cast<std::int16_t>(sixteenfold >> 4);
    out[x] = static_cast<std::uint8_t>(std::clamp<std::int16_t>(value, 0, 255));
  }
}

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

/// Lines finer than one field can show look like a movement: there the steps over six lines are
/// small beside, or contrary to, those over two.
bool CombingMeter::Cell::is_resolved() const {
  return yy < kLevelTexture * xx || yw > kResolved * yy;
}

bool Combing::is_clear() const {
  return explained > kClearlyExplained && movement_px > kClearMovement_px;
}

Combing CombingMeter::measure(const cv::Mat& grey) {
  const int step = std::max(2, grey.rows / kLines & ~1);
  const int together = std::max(1, kTogether * grey.cols / kTogetherWidth);
  const int columns = grey.cols / together;
  if (columns < 4 * kCellColumns || grey.rows < 4 * kCellRows) return {};
  cells_.assign(static_cast<std::size_t>(kCellRows * kCellColumns), {});
  for (std::vector<int>* line : {&far_above_, &above_, &here_, &below_, &far_below_}) {
    line->resize(static_cast<std::size_t>(columns));
  }
  // Between even lines, one in each equal share of the image, not always at the same place of it:
  // a texture of lines must not meet them in step.
  for (int top = 2, line = 0; top + step + 3 < grey.rows; top += step, ++line) {
    const int y = top + (step * (3 * line % 5) / 5 | 1);
    const int cell_row = y * kCellRows / grey.rows;
    add_line(grey, y, &cells_[static_cast<std::size_t>(cell_row * kCellColumns)]);
  }
  double missing = 0;
  double explained = 0;
  movements_.clear();
  const double least = kLeastContrast * together * kLeastContrast * together;
  for (const Cell& cell : cells_) {
    missing += cell.ee;
    const double determinant = cell.xx * cell.yy - cell.xy * cell.xy;
    if (cell.xx + cell.yy < least || determinant <= 1e-3 * cell.xx * cell.yy ||
        !cell.is_resolved()) {
      continue;
    }
    const double x = (cell.yy * cell.xe - cell.xy * cell.ye) / determinant;
    const double y = (cell.xx * cell.ye - cell.xy * cell.xe) / determinant;
    explained += x * cell.xe + y * cell.ye;
    movements_.push_back(std::hypot(x * together, y));
  }
  if (movements_.size() < kFewestCells || missing <= 0) return {};
  return {explained / missing, median(movements_)};
}

void CombingMeter::add_line(const cv::Mat& grey, int y, Cell* cells) {
  const int columns = static_cast<int>(here_.size());
  const int together = grey.cols / columns;
  sum_pixels(grey, y - 1, together, above_);
  sum_pixels(grey, y, together, here_);
  sum_pixels(grey, y + 1, together, below_);
  sum_pixels(grey, y - 3, together, far_above_);
  sum_pixels(grey, y + 3, together, far_below_);
  const int largest = kLargestStep * together;
  for (int cell = 0; cell < kCellColumns; ++cell) {
    const int first = std::max(1, cell * columns / kCellColumns);
    const int last = std::min(columns - 1, (cell + 1) * columns / kCellColumns);
    Cell sum;
    for (auto i = static_cast<std::size_t>(first); i < static_cast<std::size_t>(last); ++i) {
      const double across = 0.25 * (above_[i + 1] - above_[i - 1] + below_[i + 1] - below_[i - 1]);
      const double down = 0.5 * (below_[i] - above_[i]);
      const double error = here_[i] - 0.5 * (above_[i] + below_[i]);
      if (std::max({std::abs(across), std::abs(down), std::abs(error)}) > largest) continue;
      sum.xx += across * across;
      sum.xy += across * down;
      sum.yy += down * down;
      sum.xe += across * error;
      sum.ye += down * error;
      sum.ee += error * error;
      sum.yw += down * (far_below_[i] - far_above_[i]) / 6.0;
    }
    cells[cell].xx += sum.xx;
    cells[cell].xy += sum.xy;
    cells[cell].yy += sum.yy;
    cells[cell].xe += sum.xe;
    cells[cell].ye += sum.ye;
    cells[cell].ee += sum.ee;
    cells[cell].yw += sum.yw;
  }
}

void keep_even_field(const cv::Mat& grey, cv::Mat& progressive) {
  progressive.create(grey.size(), CV_8UC1);
  const int last_even = (grey.rows - 1) & ~1;
  const auto even_line = [&](int y) { return grey.ptr<std::uint8_t>(std::clamp(y, 0, last_even)); };
  for (int y = 0; y < grey.rows; ++y) {
    auto* line = progressive.ptr<std::uint8_t>(y);
    if (y % 2 == 0) {
      std::copy_n(even_line(y), grey.cols, line);
    } else {
      between(even_line(y - 3), even_line(y - 1), even_line(y + 1), even_line(y + 3), grey.cols,
              line);
    }
  }
}

const cv::Mat& FieldSeparation::take(const cv::Mat& grey) {
  if (!interlaced_ || images_++ % kLookedAtEvery == 0) weigh(meter_.measure(grey).is_clear());
  if (!interlaced_) return grey;
  keep_even_field(grey, progressive_);
  return progressive_;
}

void FieldSeparation::weigh(bool clear) {
  const int gained = clear ? (interlaced_ ? kClearCounts : 1) : -1;
  evidence_ = std::clamp(evidence_ + gained, 0, kMostEvidence);
  if (interlaced_) {
    interlaced_ = evidence_ > 0;
  } else if (evidence_ >= kSettled) {
    interlaced_ = true;
    evidence_ = kMostEvidence;
  }
}

}  // namespace handeye
