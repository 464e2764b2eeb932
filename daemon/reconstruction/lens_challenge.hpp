// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/geometry/lens_parameters.hpp"
#include "daemon/reconstruction/reconstruction.hpp"
#include "daemon/reconstruction/scene.hpp"

namespace handeye {

/// Whether the images refute other focal lengths than the one found. A covariance knows only the
/// neighbourhood of its minimum; along a valley that small turns leave open it may be confident and
/// wrong. So poses and points are made to follow a much shorter and a much longer focal length, and
/// are then let go: they must come back to `camera`, within chance by `focal_sigma_px`, or end
/// where they explain the images clearly worse. `scene`: adjusted under `camera`.
bool refutes_other_lenses(const CameraModel& camera, double focal_sigma_px, const LensPrior& prior,
                          const ReconstructionOptions& options, const Scene& scene);

}  // namespace handeye
