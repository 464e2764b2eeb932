// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/board_picture.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/aruco/charuco.hpp>

#include "protocol/exit_codes.hpp"

namespace handeye::simulator {
namespace {

/// Paper and toner are neither white nor black; nor is the table.
constexpr float kWhite = 165.0F;
constexpr float kBlack = 18.0F;
constexpr float kTable = 60.0F;

constexpr int kMarginSquares = 1;
constexpr int kMarkerBorderModules = 1;

cv::Ptr<cv::aruco::Dictionary> dictionary_of(const Board& board) {
  const auto index = dictionary_index(board.dictionary);
  if (!index) {
    throw UsageError(fmt::format("board: '{}' is none of ArUco's dictionaries; use DICT_4X4_50",
                                 board.dictionary));
  }
  return cv::aruco::getPredefinedDictionary(*index);
}

int modules_of(const Board& board) {
  if (board.kind == Board::Kind::kChessboard) return 0;
  return dictionary_of(board)->markerSize + 2 * kMarkerBorderModules;
}

int square_columns(const Board& board) {
  return board.corner_columns() + 1;
}

int square_rows(const Board& board) {
  return board.corner_rows() + 1;
}

bool is_black(int column, int row) {
  return (column + row) % 2 == 0;
}

BoardEdges edges_of(const Board& board, int squares) {
  return {squares + 2 * kMarginSquares, board.square_mm, board.marker_mm, modules_of(board)};
}

/// Length that two intervals share.
double overlap(double from, double to, double other_from, double other_to) {
  return std::max(0.0, std::min(to, other_to) - std::max(from, other_from));
}

}  // namespace

BoardEdges::BoardEdges(int squares, double square_mm, double marker_mm, int modules)
    : square_mm_(square_mm),
      module_mm_(modules > 0 ? marker_mm / modules : 0.0),
      before_marker_mm_(0.5 * (square_mm - marker_mm)),
      modules_(modules),
      squares_(squares) {
  for (int square = 0; square < squares; ++square) {
    edges_mm_.push_back(square * square_mm);
    for (int module = 0; modules > 0 && module <= modules; ++module) {
      edges_mm_.push_back(square * square_mm + before_marker_mm_ + module * module_mm_);
    }
  }
  edges_mm_.push_back(squares * square_mm);
}

int BoardEdges::cell_of(double along_mm) const {
  const double inside_mm = std::clamp(along_mm, 0.0, length_mm());
  const int square = std::min(static_cast<int>(inside_mm / square_mm_), squares_ - 1);
  if (modules_ == 0) return square;
  const double modules_passed =
      std::floor((inside_mm - square * square_mm_ - before_marker_mm_) / module_mm_);
  const int cells_a_square = modules_ + 2;
  return square * cells_a_square +
         std::clamp(1 + static_cast<int>(modules_passed), 0, cells_a_square - 1);
}

BoardPicture::BoardPicture(const Board& board)
    : columns_(edges_of(board, square_columns(board))),
      rows_(edges_of(board, square_rows(board))),
      first_corner_mm_((kMarginSquares + 1) * board.square_mm),
      albedo_(rows_.cells(), columns_.cells(), kWhite) {
  const int modules = modules_of(board);
  paint_squares(board, modules > 0 ? modules + 2 : 1);
  if (board.kind == Board::Kind::kCharuco) paint_markers(board);
}

void BoardPicture::paint_squares(const Board& board, int cells_a_square) {
  for (int row = 0; row < square_rows(board); ++row) {
    for (int column = 0; column < square_columns(board); ++column) {
      if (!is_black(column, row)) continue;
      albedo_(cv::Rect((column + kMarginSquares) * cells_a_square,
                       (row + kMarginSquares) * cells_a_square, cells_a_square, cells_a_square)) =
          kBlack;
    }
  }
}

void BoardPicture::paint_markers(const Board& board) {
  const cv::Ptr<cv::aruco::Dictionary> dictionary = dictionary_of(board);
  if (board.markers() > dictionary->bytesList.rows) {
    throw UsageError(fmt::format("board '{}': needs {} markers, {} has {}; use a larger dictionary",
                                 to_string(board), board.markers(), board.dictionary,
                                 dictionary->bytesList.rows));
  }
  const int bits = dictionary->markerSize;
  const int modules = bits + 2 * kMarkerBorderModules;
  const int cells_a_square = modules + 2;
  int marker = 0;
  for (int row = 0; row < square_rows(board); ++row) {
    for (int column = 0; column < square_columns(board); ++column) {
      if (is_black(column, row)) continue;
      cv::Mat1f cells =
          albedo_(cv::Rect((column + kMarginSquares) * cells_a_square + 1,
                           (row + kMarginSquares) * cells_a_square + 1, modules, modules));
      cells = kBlack;
      const cv::Mat white = cv::aruco::Dictionary::getBitsFromByteList(
          dictionary->bytesList.rowRange(marker, marker + 1), bits);
      cells(cv::Rect(kMarkerBorderModules, kMarkerBorderModules, bits, bits)).setTo(kWhite, white);
      ++marker;
    }
  }
}

float BoardPicture::mean(const Box& box) const {
  const double left = box.centre_x + first_corner_mm_ - 0.5 * box.width;
  const double top = box.centre_y + first_corner_mm_ - 0.5 * box.height;
  const double right = left + box.width;
  const double bottom = top + box.height;
  if (right <= 0 || bottom <= 0 || left >= width_mm() || top >= height_mm()) return kTable;
  const int first_column = columns_.cell_of(left);
  const int last_column = columns_.cell_of(right);
  const int first_row = rows_.cell_of(top);
  const int last_row = rows_.cell_of(bottom);

  double brighter_than_table = 0;
  for (int row = first_row; row <= last_row; ++row) {
    double along_row = 0;
    for (int column = first_column; column <= last_column; ++column) {
      along_row += overlap(left, right, columns_[column], columns_[column + 1]) *
                   static_cast<double>(albedo_(row, column) - kTable);
    }
    brighter_than_table += overlap(top, bottom, rows_[row], rows_[row + 1]) * along_row;
  }
  return kTable + static_cast<float>(brighter_than_table / (box.width * box.height));
}

}  // namespace handeye::simulator
