// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include "drivers/simulator/endoscope_view.hpp"
#include "drivers/simulator/world.hpp"

namespace handeye::simulator {

/// Bare hills, quickly drawn, without image noise unless asked for: whatever shows in a picture is
/// the disturbance.
inline SimulatorOptions quiet_options(std::uint64_t seed) {
  SimulatorOptions options;
  options.seed = seed;
  options.scene = SceneKind::kBare;
  options.image_noise_grey = 0;
  return options;
}

/// A picture of its own.
inline cv::Mat1b drawn(EndoscopeView& view, std::uint32_t number) {
  cv::Mat grey;
  view.draw(number, grey);
  return grey;
}

}  // namespace handeye::simulator
