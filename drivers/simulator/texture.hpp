// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

namespace handeye::simulator {

struct TextureOptions {
  double tile_mm{409.6};  ///< period along x and y
  int texels{4096};       ///< along a side of the tile, a power of two from 2048
};

/// How bright the surface is where (its albedo, 0..255), like the lining of a body cavity: mottled,
/// with large and fine vessels, glands and grain. Laid on the surface straight from above. Contains
/// nothing finer than two texels, so it can be sampled bilinearly; a second, half as fine level
/// serves views that are far or at a slant. Drawn from the seed.
class Texture {
 public:
  explicit Texture(std::uint64_t seed, const TextureOptions& options = {});

  /// Albedo 0..255 where a pixel covers `footprint_mm` of the surface at x, y.
  float sample(float x_mm, float y_mm, float footprint_mm) const {
    const float u = (x_mm + half_tile_mm_) * texels_per_mm_;
    const float v = (y_mm + half_tile_mm_) * texels_per_mm_;
    const float fine = bilinear(fine_, mask_, shift_, u, v);
    const float coarse_part = (footprint_mm * texels_per_mm_ - kFineTexels) / kBlendTexels;
    if (coarse_part <= 0) return fine;
    const float coarse = bilinear(coarse_, mask_ >> 1, shift_ - 1, 0.5F * u, 0.5F * v);
    return coarse_part >= 1 ? coarse : fine + coarse_part * (coarse - fine);
  }

  /// The fine level, for tests and pictures.
  cv::Mat1b image() const;

 private:
  /// Pixel footprints [texels] up to which the fine level is used alone, and over which it fades
  /// out.
  static constexpr float kFineTexels = 1.8F;
  static constexpr float kBlendTexels = 1.8F;

  static int floor_to_int(float value) {
    const int truncated = static_cast<int>(value);
    return truncated - static_cast<int>(value < static_cast<float>(truncated));
  }

  static float bilinear(const std::vector<std::uint8_t>& level, int mask, int shift, float u,
                        float v) {
    const int column = floor_to_int(u);
    const int row = floor_to_int(v);
    const float right = u - static_cast<float>(column);
    const float down = v - static_cast<float>(row);
    const int column0 = column & mask;
    const int column1 = (column + 1) & mask;
    const std::uint8_t* row0 = level.data() + (static_cast<std::ptrdiff_t>(row & mask) << shift);
    const std::uint8_t* row1 =
        level.data() + (static_cast<std::ptrdiff_t>((row + 1) & mask) << shift);
    const auto at = [](const std::uint8_t* texels, int index) {
      return static_cast<float>(texels[index]);
    };
    const float top = at(row0, column0) + right * (at(row0, column1) - at(row0, column0));
    const float bottom = at(row1, column0) + right * (at(row1, column1) - at(row1, column0));
    return top + down * (bottom - top);
  }

  std::vector<std::uint8_t> fine_;
  std::vector<std::uint8_t> coarse_;  ///< weighted means around every second texel
  int mask_;
  int shift_;
  float texels_per_mm_;
  float half_tile_mm_;
};

}  // namespace handeye::simulator
