// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <Eigen/Core>

namespace handeye {

/// A flat calibration board, as the command line and requests name it:
///   chessboard:COLSxROWS:SQUARE_MM                       COLS and ROWS count inner corners
///   charuco:COLSxROWS:SQUARE_MM:MARKER_MM:DICTIONARY     they count squares; e.g. DICT_4X4_50
struct Board {
  enum class Kind { kChessboard, kCharuco };

  Kind kind{Kind::kChessboard};
  int columns{0};
  int rows{0};
  double square_mm{0};
  double marker_mm{0};     ///< charuco: side of a marker, less than the square's
  std::string dictionary;  ///< charuco: one of ArUco's predefined ones

  int corner_columns() const { return kind == Kind::kChessboard ? columns : columns - 1; }
  int corner_rows() const { return kind == Kind::kChessboard ? rows : rows - 1; }

  /// The corners in the board's frame [mm], row by row: origin at the first corner, x along the
  /// columns, y along the rows, z = 0 (into the board for a viewer who sees x to the right and y
  /// down).
  std::vector<Eigen::Vector3d> corners_mm() const;
};

/// The board, or what is wrong with the text, in one line.
std::variant<Board, std::string> parse_board(std::string_view text);

/// Inverse of parse_board.
std::string to_string(const Board& board);

}  // namespace handeye
