// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "daemon/geometry/lens_parameters.hpp"
#include "daemon/reconstruction/reconstruction.hpp"
#include "daemon/reconstruction/scene.hpp"

namespace handeye {

/// The keyframes of the largest part of a reconstruction with all that was seen in them, points
/// triangulated anew: the scene that a lens is adjusted with. At most `max_keyframes`, evenly
/// chosen. `frames`: as the reconstruction was given them.
Scene scene_of(const CameraModel& camera, const Reconstruction& reconstruction,
               std::span<const TrackedFrame> frames, int max_keyframes,
               const ReconstructionOptions& options);

/// How well a scene explains what was seen in more than one of its keyframes.
struct SceneFit {
  double error_px{0};      ///< rms, each error capped at the outlier threshold, outliers included
  double inlier_ratio{0};  ///< share of the observations that agree with their points
};
SceneFit scene_fit(const CameraModel& camera, double max_reprojection_px, const Scene& scene);

/// The largest standard deviation [px] of what the distortion moves a ray by, over the area in
/// which features were seen: beyond it a lens may do what it will.
double distortion_sigma_px(const CameraModel& camera, const LensMatrix& covariance,
                           const Scene& scene);

}  // namespace handeye
