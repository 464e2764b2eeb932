// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "daemon/tracking/image_pyramid.hpp"

namespace handeye {

struct Corner {
  int x{0}, y{0};     ///< px at the working size (the pyramid's level 0)
  float strength{0};  ///< smaller eigenvalue of the mean structure tensor, (grey levels / px)^2
};

/// Shi-Tomasi corners, at most one a cell, only in cells that hold no feature: as long as features
/// live next to nothing is computed. (Detection on the whole image costs several times the
/// tracking.) Looks at the half-size image: what is sought is a patch that can be located, not the
/// tip of a corner.
class CornerGrid {
 public:
  /// `cells` is about how many cells the image is cut into; they are no smaller than
  /// min_distance_px, nor than 8 px.
  CornerGrid(cv::Size image_size, int cells, double min_distance_px);

  /// Cuts the image into smaller cells, or as few again as there were at first. The memory for the
  /// smallest was taken then.
  void cut(int cells);

  /// Corners in the empty cells of an image (a pyramid of two levels or more), in order of the
  /// cells. Their whole patch may be looked at and shows no highlight. `features`: what is tracked
  /// already; corners keep min_distance_px from it. Looks at no more than `max_cells` cells, going
  /// on where the last call ended.
  void detect(const ImagePyramid& pyramid, const std::vector<Eigen::Vector2f>& features,
              int max_cells, std::vector<Corner>& corners);

  int cell_count() const { return columns_ * rows_; }
  /// That the image can be cut into.
  int most_cells() const { return most_cells_; }

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  std::size_t index_of(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  void occupy(const std::vector<Eigen::Vector2f>& features);
  void enter(const Eigen::Vector2f& feature);
  void measure(const ImagePyramid& pyramid, cv::Rect half);
  bool best_in_cell(const ImagePyramid& pyramid, int cell, Corner& corner);
  bool is_far_from_all(float x, float y, int cell) const;

  cv::Size image_size_;
  int fewest_cells_;
  int most_cells_;
  double min_distance_px_;
  int cell_px_;
  int columns_;
  int rows_;
  int next_cell_{0};
  std::vector<std::size_t> first_of_cell_;  ///< index into entries_, or kNone
  struct Entry {
    Eigen::Vector2f pixel;
    std::size_t next;  ///< of the same cell
  };
  std::vector<Entry> entries_;
  // Scratch: products of derivatives in a cell, summed over the window step by step.
  struct Products {
    std::int32_t xx, xy, yy;
  };
  std::vector<Products> products_, row_sums_;
  std::vector<float> strength_;
};

}  // namespace handeye
