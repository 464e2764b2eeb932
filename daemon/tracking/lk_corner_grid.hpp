// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <opencv2/core.hpp>

namespace handeye {

struct LkCorner {
  cv::Point2f pixel;
  float strength{0};  ///< smaller eigenvalue of the structure tensor
};

/// Shi-Tomasi corners, at most one a cell, only in cells that hold no feature: as long as features
/// live next to nothing is computed. (Detection on the whole image costs several times the
/// tracking.)
class LkCornerGrid {
 public:
  /// `cells` is about how many cells the image is cut into.
  LkCornerGrid(cv::Size image_size, int cells, double min_distance_px);

  /// Corners in the empty cells of an image, in order of the cells; `grey` is the same before it
  /// was normalised, to see highlights in. `usable`: CV_8UC1, 255 where a corner may lie, or empty.
  /// `features`: what is tracked already; corners keep min_distance_px from it. Looks at no more
  /// than `max_cells` cells, going on where the last call ended.
  void detect(const cv::Mat& image, const cv::Mat& grey, const cv::Mat& usable,
              const std::vector<cv::Point2f>& features, int max_cells,
              std::vector<LkCorner>& corners);

  int cell_count() const { return columns_ * rows_; }

 private:
  std::size_t index_of(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  void occupy(const std::vector<cv::Point2f>& features);
  bool best_in_cell(const cv::Mat& image, const cv::Mat& usable, int cell, LkCorner& corner);
  bool is_far_from_all(cv::Point2f pixel, int cell) const;

  cv::Size image_size_;
  double min_distance_px_;
  int cell_px_;
  int columns_;
  int rows_;
  int next_cell_{0};
  std::vector<std::vector<cv::Point2f>> features_of_cell_;
  cv::Mat strength_;
};

}  // namespace handeye
