// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/wet_film.hpp"

#include "drivers/simulator/lattice_noise.hpp"

namespace handeye::simulator {
namespace {

constexpr int kNodes = 1024;
constexpr int kMask = kNodes - 1;
constexpr float kNodesPerMm = static_cast<float>(kNodes / 409.6);

/// Dents of some 3 mm with finer ones in them.
constexpr FractalOptions kDents{.first_lattice = 128, .last_lattice = 256, .gain = 0.4};
constexpr float kSlopeRms = 0.22F;

}  // namespace

WetFilm::WetFilm(std::uint64_t seed) {
  RandomStream random(seed, Purpose::kWetFilm);
  const cv::Mat1f heights = fractal_noise(kDents, kNodes, random);
  slopes_.reserve(heights.total());
  double squares = 0;
  for (int row = 0; row < kNodes; ++row) {
    for (int column = 0; column < kNodes; ++column) {
      const float along_x = heights(row, (column + 1) & kMask) - heights(row, (column - 1) & kMask);
      const float along_y = heights((row + 1) & kMask, column) - heights((row - 1) & kMask, column);
      slopes_.emplace_back(along_x, along_y);
      squares += static_cast<double>(0.5F * (along_x * along_x + along_y * along_y));
    }
  }
  const double rms = std::sqrt(squares / static_cast<double>(slopes_.size()));
  for (Eigen::Array2f& slope : slopes_) slope *= kSlopeRms / static_cast<float>(rms);
}

Eigen::Array2f WetFilm::sample(float x_mm, float y_mm) const {
  const float u = x_mm * kNodesPerMm;
  const float v = y_mm * kNodesPerMm;
  const float left = std::floor(u);
  const float top = std::floor(v);
  const float right = u - left;
  const float down = v - top;
  const auto at = [this](int row, int column) -> const Eigen::Array2f& {
    return slopes_[static_cast<std::size_t>((row & kMask) * kNodes + (column & kMask))];
  };
  const int column = static_cast<int>(left);
  const int row = static_cast<int>(top);
  const Eigen::Array2f above = at(row, column) + right * (at(row, column + 1) - at(row, column));
  const Eigen::Array2f below =
      at(row + 1, column) + right * (at(row + 1, column + 1) - at(row + 1, column));
  return above + down * (below - above);
}

}  // namespace handeye::simulator
