// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/reconstruction/scene.hpp"

namespace handeye {

/// Whether a scene, between its first, middle and last keyframe, explains too few of the features
/// that the pictures show, is contradicted by too many, or by some that obey one rotation of the
/// camera. They may well be the scene then, seen by a camera that only turns or stands, and what
/// was reconstructed an instrument that moves before it: no start, however well it fits.
bool contradicted(const Scene& scene, double threshold_rad);

}  // namespace handeye
