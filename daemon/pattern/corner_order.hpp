// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <opencv2/core.hpp>

namespace handeye {

/// Numbers the corners of a chessboard the same way in every image, whatever way a detector found
/// them: as seen from the front, x along the columns and y along the rows, and the inner square at
/// the first corner dark.
///
/// A board with one odd and one even count of corners has one such numbering. Others have two
/// (square ones with even counts four); they are told apart by the direction of the first row
/// against the image before, as long as it cannot be mistaken. After a second of images in which it
/// could be, that direction is forgotten, and the numbering may be another from then on.
class CornerOrder {
 public:
  CornerOrder(int columns, int rows) : columns_(columns), rows_(rows) {}

  /// Reorders `corners` (columns x rows of them, row by row in any of the board's orientations or
  /// mirrored). False: no chessboard, for its squares do not alternate; or an ambiguous board that
  /// has turned too far since it was last seen.
  bool arrange(const cv::Mat& grey, std::vector<cv::Point2f>& corners);

 private:
  using Corners = std::vector<cv::Point2f>;

  const cv::Point2f& at(const Corners& corners, int column, int row) const;
  void make_right_handed(Corners& corners) const;
  double contrast(const cv::Mat& grey, const Corners& corners) const;
  Corners turned_half(const Corners& corners) const;
  Corners turned_quarter(const Corners& corners) const;
  cv::Point2f first_row_direction(const Corners& corners) const;

  int columns_;
  int rows_;
  std::optional<cv::Point2f> last_direction_;  ///< of the first row, in the image before
  int refused_{0};                             ///< images in a row, for too large a turn
};

}  // namespace handeye
