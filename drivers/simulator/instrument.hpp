// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "drivers/simulator/motion.hpp"

namespace handeye::simulator {

/// A worn metal rod that comes in from a side, between scope and tissue. It swings, slides, rolls
/// and comes nearer on its own, so whatever is found on it moves as the scene does not; its shine
/// is brighter than the sensor can tell. Hides up to a third of the picture. Drawn from the seed.
class Instrument {
 public:
  Instrument(int width, int height, std::uint64_t seed);

  /// Draws it over the light of a scene; `depth_mm` becomes 0 where the scene is hidden.
  void draw(double time_s, cv::Mat1f& radiance, cv::Mat1f& depth_mm) const;

 private:
  /// Where it is in the image, px.
  struct Place {
    Eigen::Vector2f tip, backwards;  ///< backwards: unit vector away from the tip along the rod
    float radius, roll_rad;
  };
  /// A point of its surface as seen: how far back from the tip and across, in radii.
  struct Spot {
    float back, across;
  };

  Instrument(int width, int height, RandomStream random);

  Place place(double time_s) const;
  float light(const Place& place, const Spot& spot) const;
  float texture(float back, float around) const;

  int width_, height_;
  double entry_rad_;  ///< direction in which it comes in, in the image
  Wander swing_, slide_, sideways_, approach_, roll_;
  cv::Mat1f texture_;
};

}  // namespace handeye::simulator
