// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/reconstruction/scene.hpp"

namespace handeye {

/// Whether the features that a scene leaves unexplained obey one rotation of the camera. Then they
/// may well be the scene, seen by a camera that only turns or stands, and what was reconstructed is
/// an instrument that moves before it: no start, however well it fits.
/// Features too far off to have a point obey the camera's own rotation: they do not count.
bool rest_only_turns(const Scene& scene, double threshold_rad);

}  // namespace handeye
