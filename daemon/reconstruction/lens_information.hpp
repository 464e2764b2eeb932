// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "daemon/geometry/pose.hpp"
#include "daemon/reconstruction/bundle_adjustment.hpp"

namespace handeye {

/// What an adjusted scene knows about its lens.
struct LensInformation {
  /// Of the lens, poses and points free beside it; rows and columns of what was held are 0.
  LensMatrix covariance{LensMatrix::Zero()};
  double noise_px{0};  ///< per axis, from the residuals
  /// How each keyframe's pose, adjusted, answers a change of the lens: row (w [rad], dt [scene
  /// units]) of eye_from_scene -> (Exp(w) R, t + dt), column as in LensParameter. Keyframe 0 and
  /// the scale are the gauge.
  std::vector<Eigen::Matrix<double, 6, kLensParameters>> pose_by_lens;
};

/// From the normal equations of `adjust` at its minimum: points and then poses are eliminated
/// (Schur). The errors along a feature's track are not independent - a tracker that has drifted
/// stays off - so the covariance is widened, direction by direction, to that of the sum of whole
/// tracks' gradients where that is larger (the sandwich of White 1982 with clusters: Liang & Zeger
/// 1986); and no feature counts as better than 0.1 px. Nothing where the scene is too small to
/// tell.
std::optional<LensInformation> lens_information(const CameraModel& camera,
                                                const LensFreedom& freedom, double robust_px,
                                                const Scene& scene);

}  // namespace handeye
