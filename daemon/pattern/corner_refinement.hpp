// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "daemon/geometry/board.hpp"

namespace handeye {

/// An image shrunk for searching; keeps its memory from image to image.
class SearchImage {
 public:
  /// Shrinks to at most `max_width` columns; a smaller image is taken as it is, not copied.
  const cv::Mat& shrink(const cv::Mat& grey, int max_width);

  /// The last shrunk image with its illumination evened out: each pixel against the mean of a
  /// square of so many pixels a side about it. An endoscope's light falls off towards the edge.
  const cv::Mat& even_out(int side_px);

  /// From the shrunk image's pixels to the given one's.
  cv::Point2f to_full_size(const cv::Point2f& pixel) const;

 private:
  cv::Mat shrunk_;
  cv::Mat current_;  ///< the shrunk or the given one; shares its pixels
  cv::Mat mean_;
  cv::Mat even_;
  double scale_x_{1};
  double scale_y_{1};
};

/// Shortest distance between corners that are neighbours on the board [px]; 0: there are no two.
/// `ids` in ascending order, `pixels` of the same length.
double corner_spacing_px(const Board& board, std::span<const int> ids,
                         std::span<const cv::Point2f> pixels);

/// Moves corners to where the image's gradients say that they are. `window_px`: half a side of what
/// is looked at; nothing but the corner's four squares must be in it. Tells for each corner whether
/// it stayed near its start, as one does.
std::vector<bool> refine_corners(const cv::Mat& grey, double window_px, double spacing_px,
                                 std::vector<cv::Point2f>& pixels);

}  // namespace handeye
