// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace handeye {

/// A small grey image with a margin, for smallest and largest values over squares: a few passes of
/// vector instructions, without allocation once it has its size.
class PaddedGrid {
 public:
  /// Nothing happens while the size stays.
  void resize(int columns, int rows, int margin) {
    columns_ = columns;
    rows_ = rows;
    margin_ = margin;
    cells_.resize(static_cast<std::size_t>(stride()) * static_cast<std::size_t>(rows + 2 * margin));
  }
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  int stride() const { return columns_ + 2 * margin_; }

  /// y in [-margin, rows + margin); cells of a row in [-margin, columns + margin).
  std::uint8_t* row(int y) { return cells_.data() + (y + margin_) * stride() + margin_; }
  const std::uint8_t* row(int y) const {
    return cells_.data() + (y + margin_) * stride() + margin_;
  }

  /// Continues the border into the margin.
  void fill_margin() {
    for (int y = 0; y < rows_; ++y) {
      std::fill_n(row(y) - margin_, margin_, row(y)[0]);
      std::fill_n(row(y) + columns_, margin_, row(y)[columns_ - 1]);
    }
    for (int y = 1; y <= margin_; ++y) {
      std::copy_n(row(0) - margin_, stride(), row(-y) - margin_);
      std::copy_n(row(rows_ - 1) - margin_, stride(), row(rows_ - 1 + y) - margin_);
    }
  }

  /// Every cell becomes the smallest (largest) of the square of `side` cells whose first corner it
  /// is. Cells nearer than `side` to the margin's far end hold less.
  void smallest_ahead(int side) {
    slide(1, side, [](std::uint8_t a, std::uint8_t b) { return std::min(a, b); });
    slide(stride(), side, [](std::uint8_t a, std::uint8_t b) { return std::min(a, b); });
  }
  void largest_ahead(int side) {
    slide(1, side, [](std::uint8_t a, std::uint8_t b) { return std::max(a, b); });
    slide(stride(), side, [](std::uint8_t a, std::uint8_t b) { return std::max(a, b); });
  }

 private:
  /// By doubling: after each pass a cell stands for twice as many.
  template <typename Extreme>
  void slide(int unit, int side, Extreme extreme) {
    const auto count = static_cast<std::ptrdiff_t>(cells_.size());
    std::uint8_t* cells = cells_.data();
    for (int covered = 1; covered < side;) {
      const int shift = std::min(covered, side - covered);
      const std::ptrdiff_t ahead = static_cast<std::ptrdiff_t>(shift) * unit;
      for (std::ptrdiff_t i = 0; i + ahead < count; ++i)
        cells[i] = extreme(cells[i], cells[i + ahead]);
      covered += shift;
    }
  }

  int columns_{0};
  int rows_{0};
  int margin_{0};
  std::vector<std::uint8_t> cells_;
};

}  // namespace handeye
