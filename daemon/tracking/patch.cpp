// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/patch.hpp"

#include <cmath>
#include <cstring>

#include "daemon/tracking/vector_lanes.hpp"

namespace handeye {
namespace {

using lanes::Float8;
using lanes::Int8;

constexpr int kBlocks = Patch::kStride / lanes::kLanes;

Patch make_whole_patch() {
  Patch patch{};
  for (int y = 0; y < Patch::kSide; ++y) std::fill_n(patch.row(y), Patch::kSide, 1.0F);
  return patch;
}

/// From the whole pixel left above the patch, by fractions of a pixel.
HANDEYE_VECTOR_CLONES
void sample_shifted(const std::int16_t* pixels, std::ptrdiff_t stride, float right, float down,
                    float* out) {
  for (int block = 0; block < kBlocks; ++block) {
    const std::int16_t* from = pixels + block * lanes::kLanes;
    float* to = out + block * lanes::kLanes;
    Float8 left_pixel = lanes::load(from);
    Float8 above = left_pixel + right * (lanes::load(from + 1) - left_pixel);
    for (int y = 0; y < Patch::kSide; ++y) {
      from += stride;
      left_pixel = lanes::load(from);
      const Float8 below = left_pixel + right * (lanes::load(from + 1) - left_pixel);
      lanes::store(above + down * (below - above), to);
      above = below;
      to += Patch::kStride;
    }
  }
}

/// `x0`, `y0`: of the patch's first pixel, counted from `pixels` and not negative within the patch.
HANDEYE_VECTOR_CLONES
void sample_warped(const std::int16_t* pixels, std::ptrdiff_t stride, float x0, float y0,
                   const float* linear, float* out) {
  const Float8 lane{0, 1, 2, 3, 4, 5, 6, 7};
  for (int row = 0; row < Patch::kSide; ++row) {
    const float row_x = x0 + linear[1] * static_cast<float>(row);
    const float row_y = y0 + linear[3] * static_cast<float>(row);
    for (int block = 0; block < kBlocks; ++block) {
      const Float8 along = lane + static_cast<float>(block * lanes::kLanes);
      const Float8 x = row_x + linear[0] * along;
      const Float8 y = row_y + linear[2] * along;
      const Int8 column = __builtin_convertvector(x, Int8);
      const Int8 line = __builtin_convertvector(y, Int8);
      const Float8 right = x - __builtin_convertvector(column, Float8);
      const Float8 down = y - __builtin_convertvector(line, Float8);
      Int8 above{};
      Int8 below{};
      for (int i = 0; i < lanes::kLanes; ++i) {
        const std::int16_t* at = pixels + line[i] * stride + column[i];
        std::int32_t two = 0;
        std::memcpy(&two, at, sizeof two);
        above[i] = two;
        std::memcpy(&two, at + stride, sizeof two);
        below[i] = two;
      }
      // Two neighbours in one word, the left one in the lower half; grey values are not negative.
      const Float8 above_left = __builtin_convertvector(above & 0xffff, Float8);
      const Float8 above_right = __builtin_convertvector(above >> 16, Float8);
      const Float8 below_left = __builtin_convertvector(below & 0xffff, Float8);
      const Float8 below_right = __builtin_convertvector(below >> 16, Float8);
      const Float8 upper = above_left + right * (above_right - above_left);
      const Float8 lower = below_left + right * (below_right - below_left);
      lanes::store(upper + down * (lower - upper),
                   out + row * Patch::kStride + block * lanes::kLanes);
    }
  }
}

/// 1 where all four pixels that a sample is made from may be looked at; returns how many.
HANDEYE_VECTOR_CLONES
int weights_shifted(const std::uint8_t* usable, std::ptrdiff_t stride, float* weights) {
  int count = 0;
  for (int row = 0; row < Patch::kSide; ++row) {
    const std::uint8_t* above = usable + row * stride;
    const std::uint8_t* below = above + stride;
    float* out = weights + row * Patch::kStride;
    for (int x = 0; x < Patch::kSide; ++x) {
      const int may = above[x] & above[x + 1] & below[x] & below[x + 1] & 1;
      out[x] = static_cast<float>(may);
      count += may;
    }
    for (int x = Patch::kSide; x < Patch::kStride; ++x) out[x] = 0;
  }
  return count;
}

struct Box {
  int left, top, right, bottom;
};

/// Of all pixels that samples of the warped patch are made from, lanes of the padding included.
Box box_of(const AffineWarp& warp, int columns) {
  const auto first = static_cast<float>(-Patch::kRadius);
  const auto last = static_cast<float>(Patch::kRadius);
  const auto last_column = first + static_cast<float>(columns - 1);
  const auto range = [&](int axis) {
    const float across = warp.linear(axis, 0);
    const float down = warp.linear(axis, 1);
    const float low = std::min(across * first, across * last_column) - std::abs(down) * last;
    const float high = std::max(across * first, across * last_column) + std::abs(down) * last;
    // A hundredth for the sampler's own rounding.
    return std::pair(static_cast<int>(std::floor(warp.centre[axis] + low - 0.01F)),
                     static_cast<int>(std::floor(warp.centre[axis] + high + 0.01F)) + 1);
  };
  const auto [left, right] = range(0);
  const auto [top, bottom] = range(1);
  return {left, top, right, bottom};
}

bool is_near(const Eigen::Vector2f& centre, cv::Size size) {
  return centre.x() > -1e4F && centre.y() > -1e4F &&
         centre.x() < static_cast<float>(size.width) + 1e4F &&
         centre.y() < static_cast<float>(size.height) + 1e4F;
}

}  // namespace

const Patch& whole_patch() {
  static const Patch patch = make_whole_patch();
  return patch;
}

bool sample(const PaddedPlane<std::int16_t>& image, const Eigen::Vector2f& centre, Patch& patch) {
  if (!is_near(centre, image.size())) return false;
  const auto x = static_cast<int>(std::floor(centre.x()));
  const auto y = static_cast<int>(std::floor(centre.y()));
  constexpr int kRadius = Patch::kRadius;
  if (!image.holds(x - kRadius, y - kRadius, x - kRadius + Patch::kStride, y + kRadius + 1)) {
    return false;
  }
  sample_shifted(image.at(x - kRadius, y - kRadius), image.stride(),
                 centre.x() - static_cast<float>(x), centre.y() - static_cast<float>(y),
                 patch.value.data());
  return true;
}

bool sample(const PaddedPlane<std::int16_t>& image, const AffineWarp& warp, Patch& patch) {
  if (!is_near(warp.centre, image.size())) return false;
  const Box box = box_of(warp, Patch::kStride);
  if (!image.holds(box.left, box.top, box.right, box.bottom)) return false;
  const Eigen::Vector2f first =
      warp * Eigen::Vector2f::Constant(-static_cast<float>(Patch::kRadius)) -
      Eigen::Vector2f(static_cast<float>(box.left), static_cast<float>(box.top));
  const std::array<float, 4> linear{warp.linear(0, 0), warp.linear(0, 1), warp.linear(1, 0),
                                    warp.linear(1, 1)};
  sample_warped(image.at(box.left, box.top), image.stride(), first.x(), first.y(), linear.data(),
                patch.value.data());
  return true;
}

float usable_share(const ImagePyramid& pyramid, int level, const Eigen::Vector2f& centre,
                   Patch& weights) {
  const PaddedPlane<std::uint8_t>& usable = pyramid.usable(level);
  if (!is_near(centre, usable.size())) return 0;
  const int left = static_cast<int>(std::floor(centre.x())) - Patch::kRadius;
  const int top = static_cast<int>(std::floor(centre.y())) - Patch::kRadius;
  const int right = left + Patch::kSide;
  const int bottom = top + Patch::kSide;
  if (pyramid.all_usable(level, left, top, right, bottom)) return 1;
  if (!usable.holds(left, top, right, bottom)) return 0;
  const int count = weights_shifted(usable.at(left, top), usable.stride(), weights.value.data());
  return static_cast<float>(count) / static_cast<float>(Patch::kPixels);
}

float usable_share(const ImagePyramid& pyramid, int level, const AffineWarp& warp, Patch& weights) {
  const PaddedPlane<std::uint8_t>& usable = pyramid.usable(level);
  if (!is_near(warp.centre, usable.size())) return 0;
  const Box box = box_of(warp, Patch::kSide);
  if (pyramid.all_usable(level, box.left, box.top, box.right, box.bottom)) return 1;
  if (!usable.holds(box.left, box.top, box.right, box.bottom)) return 0;
  weights = whole_patch();
  int count = 0;
  for (int row = 0; row < Patch::kSide; ++row) {
    for (int column = 0; column < Patch::kSide; ++column) {
      const Eigen::Vector2f at = warp * Eigen::Vector2f(static_cast<float>(column - Patch::kRadius),
                                                        static_cast<float>(row - Patch::kRadius));
      const std::uint8_t* pixel =
          usable.at(static_cast<int>(std::floor(at.x())), static_cast<int>(std::floor(at.y())));
      const bool may =
          (pixel[0] & pixel[1] & pixel[usable.stride()] & pixel[usable.stride() + 1]) != 0;
      weights.row(row)[column] = may ? 1.0F : 0.0F;
      count += may ? 1 : 0;
    }
  }
  return static_cast<float>(count) / static_cast<float>(Patch::kPixels);
}

}  // namespace handeye
