// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/reconstruction/reconstruction.hpp"
#include "daemon/reconstruction/scene.hpp"

namespace handeye {

/// Adjusts all keyframes and points of a scene that has been kept adjusted on the way: tracks are
/// won back and outliers dropped first, and once more where the adjustment changed many verdicts.
/// Points that more frames spoke against than for are given up. A few steps reach what the images
/// can tell (measured: three do; the poses then change by less than a tenth of their error), so
/// that the time is bounded.
void adjust_finally(const CameraModel& camera, const ReconstructionOptions& options, Scene& scene);

}  // namespace handeye
