// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/geometry/board.hpp"

#include <array>
#include <charconv>
#include <optional>
#include <sstream>

namespace handeye {
namespace {

constexpr int kMostCorners = 100;  // along a side
constexpr int kFewestCorners = 2;
constexpr double kLargestSquare_mm = 1000;

constexpr std::array<std::string_view, 21> kDictionaries{
    "DICT_4X4_50",         "DICT_4X4_100",       "DICT_4X4_250",       "DICT_4X4_1000",
    "DICT_5X5_50",         "DICT_5X5_100",       "DICT_5X5_250",       "DICT_5X5_1000",
    "DICT_6X6_50",         "DICT_6X6_100",       "DICT_6X6_250",       "DICT_6X6_1000",
    "DICT_7X7_50",         "DICT_7X7_100",       "DICT_7X7_250",       "DICT_7X7_1000",
    "DICT_ARUCO_ORIGINAL", "DICT_APRILTAG_16H5", "DICT_APRILTAG_25H9", "DICT_APRILTAG_36H10",
    "DICT_APRILTAG_36H11"};

constexpr std::string_view kForms =
    "chessboard:COLSxROWS:SQUARE_MM or charuco:COLSxROWS:SQUARE_MM:MARKER_MM:DICTIONARY";

std::vector<std::string_view> fields_of(std::string_view text) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t colon = text.find(':');
    fields.push_back(text.substr(0, colon));
    if (colon == std::string_view::npos) return fields;
    text.remove_prefix(colon + 1);
  }
}

template <typename Number>
std::optional<Number> number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

bool is_length(const std::optional<double>& value_mm) {
  return value_mm && *value_mm > 0 && *value_mm <= kLargestSquare_mm;
}

std::string problem(std::string_view text, std::string_view what) {
  return "board '" + std::string(text) + "': " + std::string(what);
}

}  // namespace

std::vector<Eigen::Vector3d> Board::corners_mm() const {
  std::vector<Eigen::Vector3d> corners;
  for (int row = 0; row < corner_rows(); ++row) {
    for (int column = 0; column < corner_columns(); ++column) {
      corners.emplace_back(column * square_mm, row * square_mm, 0.0);
    }
  }
  return corners;
}

std::variant<Board, std::string> parse_board(std::string_view text) {
  const std::vector<std::string_view> fields = fields_of(text);
  Board board;
  if (fields[0] == "chessboard" && fields.size() == 3) {
    board.kind = Board::Kind::kChessboard;
  } else if (fields[0] == "charuco" && fields.size() == 5) {
    board.kind = Board::Kind::kCharuco;
  } else {
    return problem(text, "must be " + std::string(kForms));
  }
  const std::size_t cross = fields[1].find('x');
  const auto columns = number<int>(fields[1].substr(0, cross));
  const auto rows = cross == std::string_view::npos ? std::optional<int>{}
                                                    : number<int>(fields[1].substr(cross + 1));
  if (!columns || !rows) return problem(text, "COLSxROWS must be two whole numbers, e.g. 9x6");
  board.columns = *columns;
  board.rows = *rows;
  if (board.corner_columns() < kFewestCorners || board.corner_rows() < kFewestCorners ||
      board.columns > kMostCorners || board.rows > kMostCorners) {
    return problem(text, "must have 2 to 100 inner corners along each side");
  }
  const auto square_mm = number<double>(fields[2]);
  if (!is_length(square_mm)) return problem(text, "SQUARE_MM must be a length up to 1000");
  board.square_mm = *square_mm;
  if (board.kind == Board::Kind::kChessboard) return board;

  const auto marker_mm = number<double>(fields[3]);
  if (!is_length(marker_mm) || *marker_mm >= board.square_mm) {
    return problem(text, "MARKER_MM must be a length below SQUARE_MM");
  }
  board.marker_mm = *marker_mm;
  for (const std::string_view known : kDictionaries) {
    if (known == fields[4]) board.dictionary = known;
  }
  if (board.dictionary.empty()) {
    return problem(text, "DICTIONARY must be one of ArUco's, e.g. DICT_4X4_50");
  }
  return board;
}

std::string to_string(const Board& board) {
  std::ostringstream text;
  text << (board.kind == Board::Kind::kChessboard ? "chessboard:" : "charuco:") << board.columns
       << 'x' << board.rows << ':' << board.square_mm;
  if (board.kind == Board::Kind::kCharuco) {
    text << ':' << board.marker_mm << ':' << board.dictionary;
  }
  return text.str();
}

}  // namespace handeye
