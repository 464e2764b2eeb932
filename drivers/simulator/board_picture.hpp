// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "daemon/geometry/board.hpp"

namespace handeye::simulator {

/// The edges of a printed board along one of its sides, ascending from 0 [mm]: those of the squares
/// and, within each square, of a marker's modules. Finding the cell of a point takes the same few
/// steps however many there are.
class BoardEdges {
 public:
  /// `modules`: of a marker, along its side; 0: no markers.
  BoardEdges(int squares, double square_mm, double marker_mm, int modules);

  int cells() const { return static_cast<int>(edges_mm_.size()) - 1; }
  double length_mm() const { return edges_mm_.back(); }
  double operator[](int edge) const { return edges_mm_[static_cast<std::size_t>(edge)]; }

  /// The cell of a point, or the nearest.
  int cell_of(double along_mm) const;

 private:
  double square_mm_;
  double module_mm_;
  double before_marker_mm_;
  int modules_;
  int squares_;
  std::vector<double> edges_mm_;
};

/// A calibration board as it lies there: printed matt in black on white, with a white margin of one
/// square, on a dark grey table. Its albedo is constant within each cell between the edges, so
/// that means over boxes are exact, at any distance. The top left square is black; markers lie in
/// the white ones and count row by row, as OpenCV draws them (aruco, since 4.6).
class BoardPicture {
 public:
  /// Throws UsageError when the dictionary has fewer markers than the board needs.
  explicit BoardPicture(const Board& board);

  /// A rectangle in the board's frame [mm], along its axes.
  struct Box {
    double centre_x, centre_y, width, height;
  };

  /// Mean albedo 0..255 over the box.
  float mean(const Box& box) const;

  double width_mm() const { return columns_.length_mm(); }     ///< with the margin
  double height_mm() const { return rows_.length_mm(); }       ///< with the margin
  double first_corner_mm() const { return first_corner_mm_; }  ///< from the sheet's left and top

 private:
  void paint_squares(const Board& board, int cells_a_square);
  void paint_markers(const Board& board);

  BoardEdges columns_;
  BoardEdges rows_;
  double first_corner_mm_;
  cv::Mat1f albedo_;  ///< of every cell, row by row
};

}  // namespace handeye::simulator
