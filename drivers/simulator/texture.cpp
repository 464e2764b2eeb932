// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/texture.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "drivers/simulator/lattice_noise.hpp"

namespace handeye::simulator {
namespace {

/// Dark lines of about constant width along the zero contour of a random field: 0..1.
cv::Mat1f vessels(const FractalOptions& course, double half_width_texels, int size,
                  RandomStream& random) {
  const cv::Mat1f field = fractal_noise(course, size, random);
  const int mask = size - 1;
  cv::Mat1f depth(size, size);
  for (int row = 0; row < size; ++row) {
    const float* above = field[(row - 1) & mask];
    const float* here = field[row];
    const float* below = field[(row + 1) & mask];
    for (int i = 0; i < size; ++i) {
      const float along_x = 0.5F * (here[(i + 1) & mask] - here[(i - 1) & mask]);
      const float along_y = 0.5F * (below[i] - above[i]);
      // Value over gradient is the distance to the contour, to first order.
      const float slope = along_x * along_x + along_y * along_y + 1e-9F;
      const auto width = static_cast<float>(half_width_texels * half_width_texels);
      depth(row, i) = std::exp(-here[i] * here[i] / (slope * width));
    }
  }
  return depth;
}

/// 0 where the field is low, 1 where it is high: makes vessels come and go.
cv::Mat1f presence(int lattice_size, int size, RandomStream& random) {
  cv::Mat1f field = spline_noise(lattice_size, size, random);
  for (float& value : field) value = std::clamp(0.5F + 0.7F * value, 0.0F, 1.0F);
  return field;
}

/// Small round spots where a fine field peaks: 0 and up.
cv::Mat1f spots(int lattice_size, float threshold, int size, RandomStream& random) {
  cv::Mat1f field = spline_noise(lattice_size, size, random);
  for (float& value : field) value = std::max(0.0F, value - threshold);
  return field;
}

/// Albedo 0..1 (about) at half the final resolution. Lattice sizes are for a tile of 409.6 mm.
cv::Mat1f paint(int size, double texel_mm, RandomStream& random) {
  cv::Mat1f albedo(size, size, 0.56F);
  albedo += 0.085 * fractal_noise({16, 128, 0.7}, size, random);
  albedo -= 0.24 *
            vessels({32, 128, 0.35}, 0.45 / texel_mm, size, random).mul(presence(32, size, random));
  albedo -= 0.17 *
            vessels({128, 512, 0.4}, 0.22 / texel_mm, size, random).mul(presence(64, size, random));
  albedo += 0.16 * spots(512, 1.3F, size, random);
  albedo -= 0.20 * spots(512, 1.5F, size, random);
  albedo += 0.075 * fractal_noise({256, size, 0.75}, size, random);
  return albedo;
}

}  // namespace

Texture::Texture(std::uint64_t seed, const TextureOptions& options)
    : mask_(options.texels - 1),
      shift_(std::countr_zero(static_cast<unsigned>(options.texels))),
      texels_per_mm_(static_cast<float>(options.texels / options.tile_mm)),
      half_tile_mm_(static_cast<float>(options.tile_mm / 2)) {
  RandomStream random(seed, Purpose::kTexture);
  const int half = options.texels / 2;
  cv::Mat1b fine;
  subdivide(paint(half, options.tile_mm / half, random)).convertTo(fine, CV_8U, 255.0);
  fine_.assign(fine.begin(), fine.end());

  // Centred on every second texel, about which the refined lattice is symmetric: so both levels
  // show the same things at the same place.
  coarse_.reserve(static_cast<std::size_t>(half) * static_cast<std::size_t>(half));
  for (int row = 0; row < options.texels; row += 2) {
    const std::uint8_t* above = fine[(row - 1) & mask_];
    const std::uint8_t* here = fine[row];
    const std::uint8_t* below = fine[row + 1];
    const auto column_sum = [&](int i) { return above[i] + 2 * here[i] + below[i]; };
    for (int i = 0; i < options.texels; i += 2) {
      const int sum = column_sum((i - 1) & mask_) + 2 * column_sum(i) + column_sum(i + 1);
      coarse_.push_back(static_cast<std::uint8_t>((sum + 8) / 16));
    }
  }
}

cv::Mat1b Texture::image() const {
  cv::Mat1b image(mask_ + 1, mask_ + 1);
  std::copy(fine_.begin(), fine_.end(), image.begin());
  return image;
}

}  // namespace handeye::simulator
