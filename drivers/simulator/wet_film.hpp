// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace handeye::simulator {

/// A film of fluid on the surface that mirrors the lamp. It is uneven: small dents tilt its normal,
/// so that wherever the surface is about square to the view some of them throw the light back.
/// Drawn from the seed.
class WetFilm {
 public:
  explicit WetFilm(std::uint64_t seed);

  /// Blinn's highlight with a Gaussian lobe, 0..1, at a point of the surface with slopes dz/dx and
  /// dz/dy. `halfway`: any vector halfway between the directions to lamp and eye.
  float glint(const Eigen::Array4f& point, float slope_x, float slope_y,
              const Eigen::Array4f& halfway) const {
    const Eigen::Array2f tilt = sample(point[0], point[1]);
    // The slopes a mirror would need here, less those it has.
    const float miss_x = -halfway[0] / halfway[2] - slope_x - tilt[0];
    const float miss_y = -halfway[1] / halfway[2] - slope_y - tilt[1];
    const float miss_squared = (miss_x * miss_x + miss_y * miss_y) / kLobeSquared;
    return miss_squared < 9.0F ? std::exp(-miss_squared) : 0.0F;
  }

  /// How much brighter than a white surface it mirrors the lamp.
  static constexpr float kShine = 6.0F;

 private:
  static constexpr float kLobeSquared = 0.032F * 0.032F;

  Eigen::Array2f sample(float x_mm, float y_mm) const;

  std::vector<Eigen::Array2f> slopes_;  ///< at the nodes of a periodic grid, row by row
};

}  // namespace handeye::simulator
