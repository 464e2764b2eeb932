// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace handeye::simulator {

struct ReliefOptions {
  double tile_mm{409.6};         ///< period along x and y
  int nodes{1024};               ///< along a side of the tile, a power of two
  double peak_to_peak_mm{14.0};  ///< at most: lowered where the slope would be too steep
  double max_slope{0.5};         ///< below tan(90 deg - steepest view): nothing hides behind a hill
};

/// A hilly surface z = height(x, y) over the whole plane, in surface coordinates (mm, z towards the
/// viewer): bilinear between the nodes of a periodic grid, which is the definition, not an
/// approximation of something else. Drawn from the seed.
class Relief {
 public:
  /// Height and slopes at a node; the fourth number pads to one SIMD register.
  using Node = Eigen::Array4f;

  explicit Relief(std::uint64_t seed, const ReliefOptions& options = {});

  /// Bilinear height [mm].
  double height(double x_mm, double y_mm) const;

  /// Distance along the ray, in units of |direction|, to where it first meets the surface. Sphere
  /// tracing with the slope's bound, so it cannot step over a hill. Nothing when the ray starts
  /// below the surface or does not come down to it within `limit`.
  std::optional<double> intersect(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                  double limit) const;

  /// Height and smoothed slopes (for shading) at surface coordinates, bilinear, single precision.
  Node sample(float x_mm, float y_mm) const {
    const float u = (x_mm + half_tile_mm_) * nodes_per_mm_;
    const float v = (y_mm + half_tile_mm_) * nodes_per_mm_;
    const int column = floor_to_int(u);
    const int row = floor_to_int(v);
    const float right = u - static_cast<float>(column);
    const float down = v - static_cast<float>(row);
    const int column0 = column & mask_;
    const int column1 = (column + 1) & mask_;
    const Node* row0 = nodes_.data() + static_cast<std::ptrdiff_t>(row & mask_) * (mask_ + 1);
    const Node* row1 = nodes_.data() + static_cast<std::ptrdiff_t>((row + 1) & mask_) * (mask_ + 1);
    const Node top = row0[column0] + right * (row0[column1] - row0[column0]);
    const Node bottom = row1[column0] + right * (row1[column1] - row1[column0]);
    return top + down * (bottom - top);
  }

  double lowest_mm() const { return lowest_mm_; }
  double highest_mm() const { return highest_mm_; }

 private:
  static int floor_to_int(float value) {
    const int truncated = static_cast<int>(value);
    return truncated - static_cast<int>(value < static_cast<float>(truncated));
  }

  std::vector<Node> nodes_;  ///< row by row
  int mask_;                 ///< nodes along a side, minus 1
  float nodes_per_mm_;
  float half_tile_mm_;
  double slope_bound_{0};  ///< of the bilinear surface, in any direction
  double lowest_mm_{0};
  double highest_mm_{0};
};

}  // namespace handeye::simulator
