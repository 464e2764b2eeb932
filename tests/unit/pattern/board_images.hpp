// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <random>
#include <vector>

#include <opencv2/core.hpp>

#include "daemon/geometry/board.hpp"
#include "daemon/geometry/camera_model.hpp"
#include "daemon/geometry/pose.hpp"

namespace handeye::test {

/// Pictures of a board, cast ray by ray through the lens onto a plane, with
/// the optics' blur and a little noise.
class BoardImages {
 public:
  BoardImages(const Board& board, const CameraModel& camera);

  /// Grey image with the board where it is; the rest is an even grey.
  cv::Mat image(const Pose& eye_from_board);

  /// The corners' true pixels, in the order of Board::corners_mm.
  std::vector<Eigen::Vector2d> true_pixels(const Pose& eye_from_board) const;

 private:
  Eigen::Vector2d ray(int column, int row, double x, double y) const;
  std::uint8_t grey_at(const Eigen::Vector2d& board_mm) const;

  Board board_;
  CameraModel camera_;
  cv::Mat print_;                      ///< the board, seen from the front
  std::vector<Eigen::Vector2d> rays_;  ///< x/z, y/z of the pixels' corners, row by row
  std::mt19937 random_{5};
};

/// Lens of an ordinary endoscope, 640x480.
inline CameraModel endoscope() {
  return {640, 480, 520, 522, 324, 236, {-0.22, 0.06, 0.0008, -0.0005, 0}};
}

/// The board's middle on the optical axis plus `shift_mm`, at a distance, tilted by a rotation
/// vector [rad].
Pose board_in_view(const Board& board, double distance_mm, const Eigen::Vector3d& tilt,
                   const Eigen::Vector2d& shift_mm = Eigen::Vector2d::Zero());

inline Board chessboard(int columns, int rows, double square_mm) {
  Board board;
  board.columns = columns;
  board.rows = rows;
  board.square_mm = square_mm;
  return board;
}
inline Board charuco(int columns, int rows, double square_mm, double marker_mm) {
  Board board = chessboard(columns, rows, square_mm);
  board.kind = Board::Kind::kCharuco;
  board.marker_mm = marker_mm;
  board.dictionary = "DICT_4X4_50";
  return board;
}

}  // namespace handeye::test
