// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/pattern/board_detector.hpp"

#include "daemon/pattern/detectors.hpp"

namespace handeye {

std::unique_ptr<BoardDetector> make_board_detector(const Board& board,
                                                   const BoardDetectorOptions& options) {
  if (board.kind == Board::Kind::kChessboard) return make_chessboard_detector(board, options);
  return make_charuco_detector(board, options);
}

bool is_ambiguous(const Board& board) {
  return board.kind == Board::Kind::kChessboard && (board.columns + board.rows) % 2 == 0;
}

}  // namespace handeye
