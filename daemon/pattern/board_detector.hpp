// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "daemon/geometry/board.hpp"

namespace handeye {

/// An inner corner of a board, seen in an image.
struct BoardCorner {
  int id{0};                                       ///< index into Board::corners_mm()
  Eigen::Vector2d pixel{Eigen::Vector2d::Zero()};  ///< px, pixel centres at integers
};

struct BoardDetectorOptions {
  /// Look harder: for single pictures, where a second is nothing. In a video a frame that shows no
  /// board must be done soon (one of three ways of searching a frame), and another comes.
  bool thorough{false};
};

/// Finds one board in images. One thread; images in order of time where the board is ambiguous.
class BoardDetector {
 public:
  BoardDetector() = default;
  BoardDetector(const BoardDetector&) = delete;
  BoardDetector& operator=(const BoardDetector&) = delete;
  virtual ~BoardDetector() = default;

  /// Writes the corners found in the image (CV_8UC1), ordered by id; none: the board is not there,
  /// or not enough of it. A chessboard is found as a whole or not at all; of a ChArUco board part
  /// is enough.
  virtual void detect(const cv::Mat& grey, std::vector<BoardCorner>& corners) = 0;
};

/// The detector for a kind of board.
///
/// Chessboard: the first corner is the one whose inner square (that between the first two corners
/// of the first two rows) is dark, as on OpenCV's boards. Where that leaves a choice
/// (is_ambiguous), it is the one nearest in direction to what the image before showed.
/// ChArUco: OpenCV's boards of 4.6 and later: top left square dark, markers numbered row by row.
std::unique_ptr<BoardDetector> make_board_detector(const Board& board,
                                                   const BoardDetectorOptions& options = {});

/// A chessboard that looks the same turned by half a turn: both or neither of its corner counts
/// are odd.
bool is_ambiguous(const Board& board);

}  // namespace handeye
