// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <Eigen/Core>

namespace handeye {

/// One of ArUco's predefined sets of markers.
struct MarkerDictionary {
  std::string_view name;
  int markers{0};
};

/// All of them, in the order of OpenCV's enumeration cv::aruco::PREDEFINED_DICTIONARY_NAME.
inline constexpr std::array<MarkerDictionary, 21> kMarkerDictionaries{{
    {"DICT_4X4_50", 50},        {"DICT_4X4_100", 100},         {"DICT_4X4_250", 250},
    {"DICT_4X4_1000", 1000},    {"DICT_5X5_50", 50},           {"DICT_5X5_100", 100},
    {"DICT_5X5_250", 250},      {"DICT_5X5_1000", 1000},       {"DICT_6X6_50", 50},
    {"DICT_6X6_100", 100},      {"DICT_6X6_250", 250},         {"DICT_6X6_1000", 1000},
    {"DICT_7X7_50", 50},        {"DICT_7X7_100", 100},         {"DICT_7X7_250", 250},
    {"DICT_7X7_1000", 1000},    {"DICT_ARUCO_ORIGINAL", 1024}, {"DICT_APRILTAG_16H5", 30},
    {"DICT_APRILTAG_25H9", 35}, {"DICT_APRILTAG_36H10", 2320}, {"DICT_APRILTAG_36H11", 587},
}};

/// Index into kMarkerDictionaries and OpenCV's number of the dictionary; nothing: there is none.
std::optional<int> dictionary_index(std::string_view name);

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

  /// charuco: one in every light square.
  int markers() const { return kind == Kind::kChessboard ? 0 : columns * rows / 2; }

  /// The corners in the board's frame [mm], row by row: origin at the first corner, x along the
  /// columns, y along the rows, z = 0 (into the board for a viewer who sees x to the right and y
  /// down).
  std::vector<Eigen::Vector3d> corners_mm() const;
};

/// The board, or what is wrong with the text, in one line of printable ASCII. Every board that is
/// accepted can be detected: at least 3x3 inner corners of a chessboard, 2x2 of a ChArUco board,
/// whose dictionary has markers enough; squares of 0.01 to 1000 mm.
std::variant<Board, std::string> parse_board(std::string_view text);

/// Inverse of parse_board.
std::string to_string(const Board& board);

}  // namespace handeye
