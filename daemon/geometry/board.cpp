// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/geometry/board.hpp"

#include <algorithm>
#include <charconv>
#include <sstream>

namespace handeye {
namespace {

constexpr int kMostCorners = 100;            // along a side
constexpr int kFewestChessboardCorners = 3;  // OpenCV's search asks for them
constexpr int kFewestCharucoCorners = 2;
constexpr double kSmallestLength_mm = 0.01;
constexpr double kLargestLength_mm = 1000;
constexpr std::size_t kLongestEcho = 60;

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
  return value_mm && *value_mm >= kSmallestLength_mm && *value_mm <= kLargestLength_mm;
}

/// The text comes from anybody on the network, and ends in logs, terminals and JSON.
std::string echo(std::string_view text) {
  std::string clean(text.substr(0, kLongestEcho));
  std::ranges::replace_if(
      clean, [](char c) { return c < ' ' || c > '~'; }, '?');
  return text.size() > kLongestEcho ? clean + "..." : clean;
}

std::string problem(std::string_view text, std::string_view what) {
  return "board '" + echo(text) + "': " + std::string(what);
}

// Apart: GCC 12 warns of a string plus a temporary number.
std::string number_text(int value) {
  return std::to_string(value);
}

int fewest_corners(Board::Kind kind) {
  return kind == Board::Kind::kChessboard ? kFewestChessboardCorners : kFewestCharucoCorners;
}

}  // namespace

std::optional<int> dictionary_index(std::string_view name) {
  const auto* const found = std::ranges::find(kMarkerDictionaries, name, &MarkerDictionary::name);
  if (found == kMarkerDictionaries.end()) return std::nullopt;
  return static_cast<int>(found - kMarkerDictionaries.begin());
}

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
  const int fewest = fewest_corners(board.kind);
  if (std::min(*columns, *rows) < 1 || std::max(*columns, *rows) > kMostCorners ||
      std::min(board.corner_columns(), board.corner_rows()) < fewest) {
    return problem(text,
                   "must have " + number_text(fewest) + " to 100 inner corners along each side");
  }
  const auto square_mm = number<double>(fields[2]);
  if (!is_length(square_mm)) return problem(text, "SQUARE_MM must be a length from 0.01 to 1000");
  board.square_mm = *square_mm;
  if (board.kind == Board::Kind::kChessboard) return board;

  const auto marker_mm = number<double>(fields[3]);
  // OpenCV compares them in single precision.
  if (!is_length(marker_mm) ||
      static_cast<float>(*marker_mm) >= static_cast<float>(board.square_mm)) {
    return problem(text, "MARKER_MM must be a length from 0.01 to below SQUARE_MM");
  }
  board.marker_mm = *marker_mm;
  const auto dictionary = dictionary_index(fields[4]);
  if (!dictionary) return problem(text, "DICTIONARY must be one of ArUco's, e.g. DICT_4X4_50");
  const MarkerDictionary& markers = kMarkerDictionaries[static_cast<std::size_t>(*dictionary)];
  board.dictionary = markers.name;
  if (board.markers() > markers.markers) {
    return problem(text, "needs " + number_text(board.markers()) + " markers, " + board.dictionary +
                             " has " + number_text(markers.markers));
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
