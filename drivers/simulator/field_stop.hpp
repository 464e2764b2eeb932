// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace handeye::simulator {

/// The round stop in a scope's eyepiece: a bright disc about the image's middle, as high as the
/// image but for a margin, with a soft rim and a faint glow just outside. It stands still. Where
/// exactly is drawn from the seed.
class FieldStop {
 public:
  FieldStop(int width, int height, std::uint64_t seed);

  void apply(cv::Mat1f& radiance) const;

  Eigen::Vector2d centre_px() const { return centre_px_; }
  double radius_px() const { return radius_px_; }  ///< where half of the light is left

 private:
  Eigen::Vector2d centre_px_;
  double radius_px_;
  cv::Mat1f passes_;  ///< share of the light, 0..1
  cv::Mat1f glow_;    ///< radiance that comes on top
};

}  // namespace handeye::simulator
