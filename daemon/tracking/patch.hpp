// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "daemon/tracking/image_pyramid.hpp"

namespace handeye {

/// A square of grey values around a feature; rows are padded to whole vectors, the padding is zero.
struct alignas(32) Patch {
  static constexpr int kRadius = 11;
  static constexpr int kSide = 2 * kRadius + 1;
  static constexpr int kStride = 24;
  static constexpr int kPixels = kSide * kSide;

  float* row(int y) { return value.data() + y * kStride; }
  const float* row(int y) const { return value.data() + y * kStride; }

  std::array<float, kSide * kStride> value;
};

/// How a patch lies in an image: image px = centre + linear * patch px.
struct AffineWarp {
  Eigen::Vector2f centre{Eigen::Vector2f::Zero()};
  Eigen::Matrix2f linear{Eigen::Matrix2f::Identity()};

  Eigen::Vector2f operator*(const Eigen::Vector2f& offset) const {
    return centre + linear * offset;
  }
};

/// 1 in every pixel of the patch, 0 in its padding.
const Patch& whole_patch();

/// Samples the image around a centre, bilinearly. False where the patch leaves the padding.
bool sample(const PaddedPlane<std::int16_t>& image, const Eigen::Vector2f& centre, Patch& patch);

/// The same through an affine warp.
bool sample(const PaddedPlane<std::int16_t>& image, const AffineWarp& warp, Patch& patch);

/// Where the patch may be looked at: 1, elsewhere 0. Returns the share of its pixels, and leaves
/// `weights` alone when that is all of them (the usual case, and quick).
float usable_share(const ImagePyramid& pyramid, int level, const Eigen::Vector2f& centre,
                   Patch& weights);

/// The same through an affine warp.
float usable_share(const ImagePyramid& pyramid, int level, const AffineWarp& warp, Patch& weights);

}  // namespace handeye
