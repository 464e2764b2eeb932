// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/reconstruction/bundle_adjustment.hpp"
#include "daemon/reconstruction/scene.hpp"

namespace handeye {

/// The newest keyframes of a scene and the trusted points they see, as a scene of its own: it can
/// be adjusted on another thread while the first goes on growing.
struct AdjustmentWindow {
  CameraModel camera;
  AdjustmentOptions options;
  Scene scene;
  int first_keyframe{0};    ///< of the whole scene, that is the window's first
  std::vector<int> tracks;  ///< of the whole scene, for each of the window's
};

/// Cuts out what an adjustment of the whole scene with these options would touch.
AdjustmentWindow cut_window(const CameraModel& camera, const AdjustmentOptions& options,
                            const Scene& scene);

void adjust(AdjustmentWindow& window);

/// Puts the adjusted keyframes and points back. Keyframes may have been added to the scene since,
/// but none removed; points given up since stay so.
void take_over(const AdjustmentWindow& window, Scene& scene);

}  // namespace handeye
