// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "daemon/session/calibration_watch_points.hpp"

namespace handeye {

/// Leaves out features that go their own way: whose error is more than `most_times` the usual one
/// and `most_sigmas` of its own standard deviations (few sights tell it badly), or that came to the
/// near end of `depth`, where anything is explained.
struct WatchWild {
  double most_times{3.0};
  double most_sigmas{0.0};
};
void leave_out_wild_tracks(double image_noise, const WatchDepth& depth, const WatchWild& wild,
                           WatchUnknowns& at);

/// About as deep as the points lie that were found.
WatchDepth scene_depth(const WatchUnknowns& at);

struct WatchImageResiduals {
  double squared{0};  ///< of the inliers
  std::size_t inliers{0}, sights{0};
  std::size_t tracks{0};  ///< that have inliers
};
/// `within`: of an inlier, at focal length 1.
WatchImageResiduals watch_image_residuals(const WatchUnknowns& at, double within);

double watch_hand_chi2(std::span<const WatchFrame> frames, const WatchUnknowns& at);

/// By how many times the hand's errors widen what is found because they last from frame to frame:
/// one and twice the correlations of its residuals with those of later frames, as far as these are
/// clearly above zero (Newey, West 1987).
double watch_hand_lasting(std::span<const WatchFrame> frames, const WatchUnknowns& at);

}  // namespace handeye
