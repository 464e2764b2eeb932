// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/geometry/lens_parameters.hpp"
#include "daemon/reconstruction/scene.hpp"

namespace handeye {

struct AdjustmentOptions {
  int first_variable{0};  ///< keyframes from here on move; those before stay as they are
  int max_fixed{12};      ///< of those before, this many (nearest in time) hold the window in place
  double robust_px{1.5};  ///< Huber
  int max_iterations{50};
  double function_tolerance{1e-9};  ///< relative change of the cost that ends it
  int threads{1};
};

/// Minimises the robust reprojection error [px] of the inlier observations over keyframe poses and
/// points, intrinsics fixed (Triggs et al., Bundle Adjustment - A Modern Synthesis, 2000).
/// The gauge: two or more fixed keyframes, or else the first keyframe and one component of the
/// translation of the one farthest from it.
/// Returns the rms reprojection error [px] over the observations it used.
double adjust(const CameraModel& camera, const AdjustmentOptions& options, Scene& scene);

/// What an adjustment may move of the lens.
struct LensFreedom {
  std::array<bool, kLensParameters> free{};  ///< indexed by LensParameter
  LensPrior prior;
  double noise_px{0.5};  ///< of the features, that the prior is weighed against
};

/// The same with the lens, or some of it, free: starts from `camera` and leaves it there; the rays
/// kept in the scene follow it.
double adjust(const LensFreedom& freedom, const AdjustmentOptions& options, Scene& scene,
              CameraModel& camera);

}  // namespace handeye
