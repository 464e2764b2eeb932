// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/geometry/camera_model.hpp"
#include "daemon/reconstruction/reconstruction.hpp"
#include "daemon/reconstruction/scene.hpp"
#include "daemon/reconstruction/start_method.hpp"
#include "daemon/reconstruction/start_window.hpp"

namespace handeye {

/// A hypothesis with its points, measured against the images.
struct StartCandidate {
  StartMethod method{StartMethod::kTwoViews};
  Scene scene;                  ///< a keyframe for each frame whose pose the hypothesis knows
  int missing_observations{0};  ///< in the frames of the window whose pose it does not know
  /// Rms over all observations, each capped at max_reprojection_px; the missing count as that.
  double error_px{0};
  double inlier_ratio{0};  ///< share of all observations that agree with a point in front
  double parallax_rad{0};  ///< median over the points of the largest angle between two rays
};

/// Triangulates at most `most_tracks` features of the window from the hypothesis' poses.
StartCandidate make_candidate(const CameraModel& camera, const ReconstructionOptions& options,
                              const StartWindow& window, const StartHypothesis& hypothesis,
                              Eigen::Index most_tracks);

/// Adjusts poses and points, wins points back and gives others up, and measures again.
void adjust_candidate(const CameraModel& camera, const ReconstructionOptions& options,
                      StartCandidate& candidate);

/// The scene with the poses of a candidate and everything that the frames show, adjusted. Its first
/// keyframe is the origin, the distance of the farthest from it the unit.
StartCandidate complete_candidate(const CameraModel& camera, const ReconstructionOptions& options,
                                  const StartWindow& window, const StartCandidate& candidate);

}  // namespace handeye
