// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "daemon/tracking/padded_plane.hpp"

namespace handeye {

/// One image as the tracker sees it: lightly smoothed (binomial, 3x3), and at a half, a quarter...
/// of its size, each with a plane that says where it may be looked at. A pixel of level k is the
/// middle of what it stands for at (2^k x, 2^k y) of level 0.
///
/// The smoothing is what lets a bilinear sample stand for the image: between the pixels of the raw
/// image it would be wrong by some hundredths of a pixel of movement.
class ImagePyramid {
 public:
  static constexpr int kMaxLevels = 6;
  /// Grey values are in sixteenths: what the binomial filter yields, unrounded.
  static constexpr float kUnitsPerGrey = 16.0F;

  /// Takes in an image (CV_8UC1) and its mask (CV_8UC1, 0 = do not look, or empty). Level 0 has
  /// 1/2^halvings of the image's size. Memory is kept while the size stays.
  void build(const cv::Mat& grey, const cv::Mat& mask, int halvings, int levels);

  int levels() const { return levels_; }
  const PaddedPlane<std::int16_t>& grey(int level) const { return grey_[index(level)]; }

  /// 255 where the pixel may be looked at, 0 elsewhere and in the padding.
  const PaddedPlane<std::uint8_t>& usable(int level) const { return usable_[index(level)]; }

  /// May all pixels of [left, right] x [top, bottom] be looked at? Within image and padding.
  bool all_usable(int level, int left, int top, int right, int bottom) const;

  /// Fraction of level 0 that may be looked at.
  double usable_share() const { return usable_share_; }

 private:
  static std::size_t index(int level) { return static_cast<std::size_t>(level); }
  void build_usable(const cv::Mat& mask, int halvings);

  int levels_{0};
  double usable_share_{1.0};
  bool whole_image_usable_{false};
  std::array<PaddedPlane<std::int16_t>, kMaxLevels> grey_;
  std::array<PaddedPlane<std::uint8_t>, kMaxLevels> usable_;
  cv::Mat shrunk_, shrunk_twice_;  ///< of a wide image
  std::vector<std::int16_t> column_sums_;
  cv::Mat mask_;         ///< as given last
  cv::Mat shrunk_mask_;  ///< of a wide image
};

}  // namespace handeye
