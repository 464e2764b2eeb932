// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "daemon/tracking/padded_grid.hpp"

namespace handeye {

/// Masks what mirrors the light: spots on wet tissue that move with the light and make perfect
/// corners of nothing. They are small, sharp-edged, and near saturation. Tissue close to the light
/// is bright over a wide area and stays in use, but where it is clipped nothing is left to follow.
///
/// Works at half of VGA whatever the image's size. Only grey is known, not that the spots are
/// white. Memory is kept from image to image.
class Highlights {
 public:
  /// Where features may be sought: CV_8UC1, 255 = usable; `field_of_view` without the highlights of
  /// `grey` (CV_8UC1). Empty: everywhere. `field_of_view`: of the image's size, or empty. Valid
  /// until the next call and as long as `field_of_view` is.
  const cv::Mat& usable(const cv::Mat& grey, const cv::Mat& field_of_view);

 private:
  void shrink(const cv::Mat& grey);
  bool find();
  void write(cv::Size size, const cv::Mat& field_of_view);

  int side_{1};           ///< of a cell [px]
  PaddedGrid brightest_;  ///< of each cell
  PaddedGrid surroundings_;
  PaddedGrid clipped_;
  PaddedGrid spots_;  ///< 255: a highlight
  std::vector<std::uint8_t> line_;
  cv::Mat usable_;
};

}  // namespace handeye
