// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/field_stop.hpp"

#include <algorithm>
#include <cmath>

#include "drivers/simulator/random_stream.hpp"

namespace handeye::simulator {
namespace {

/// At 480 px image height.
constexpr double kOffCentrePx = 10.0;
constexpr double kMarginPx = 12.0;
constexpr double kRimPx = 3.0;    ///< over which the light falls from 1 to 0
constexpr double kGlowPx = 10.0;  ///< over which the glow falls to 1/e
constexpr double kGlow = 0.02;    ///< radiance at the rim: some 7 grey levels

}  // namespace

FieldStop::FieldStop(int width, int height, std::uint64_t seed)
    : passes_(height, width), glow_(height, width) {
  RandomStream random(seed, Purpose::kFieldStop);
  const double scale = height / 480.0;
  const double off_x = random.uniform(-kOffCentrePx, kOffCentrePx);
  const double off_y = random.uniform(-kOffCentrePx, kOffCentrePx);
  centre_px_ = {0.5 * (width - 1) + scale * off_x, 0.5 * (height - 1) + scale * off_y};
  radius_px_ = 0.5 * std::min(width, height) - scale * kMarginPx;
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const double outside_px = (Eigen::Vector2d(column, row) - centre_px_).norm() - radius_px_;
      const double ramp = std::clamp(0.5 - outside_px / (scale * kRimPx), 0.0, 1.0);
      passes_(row, column) = static_cast<float>(ramp * ramp * (3.0 - 2.0 * ramp));
      const double dimming = std::exp(-std::max(outside_px, 0.0) / (scale * kGlowPx));
      glow_(row, column) = static_cast<float>(kGlow * dimming * (1.0 - ramp));
    }
  }
}

void FieldStop::apply(cv::Mat1f& radiance) const {
  for (int row = 0; row < radiance.rows; ++row) {
    float* light = radiance[row];
    const float* passes = passes_[row];
    const float* glow = glow_[row];
    for (int i = 0; i < radiance.cols; ++i) light[i] = light[i] * passes[i] + glow[i];
  }
}

}  // namespace handeye::simulator
