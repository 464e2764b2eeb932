// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "daemon/session/calibration_watch_equations.hpp"

namespace handeye {

struct WatchFitOptions {
  double image_noise{0.001};    ///< of a ray, per axis, at focal length 1
  double time_offset_s{0.002};  ///< standard deviation of what it may be off
  int max_iterations{10};       ///< of one of the stages
  /// How near hand_from_eye is held to the calibration, or at first to the start.
  double held_rotation_rad{0.003};
  double held_translation_mm{1.0};
  std::size_t min_sights{3};  ///< of a feature, to count
  int min_tracks{15};
};

/// hand_from_eye as a stretch of frames has it, and how well they explain each other.
struct WatchFit {
  Pose hand_from_eye{Pose::Identity()};
  /// Of (w [rad], dt [mm]) in R = Exp(w) R_fit, t = t_fit + dt, all else free; huge where the
  /// motion does not tell. Widened where hand or images are noisier than assumed, and for errors of
  /// a feature that last.
  Matrix6d covariance{Matrix6d::Zero()};
  double hand_excess{0};   ///< variance of the hand's residuals over what was assumed
  double image_excess{0};  ///< likewise of the images', outliers aside
  /// By how many times both sides of a comparison are less sure than the covariance says, because
  /// errors of the hand last from frame to frame.
  double lasting{1};
  double outliers{0};   ///< share of the sights beyond the bend of the loss
  double cost{0};       ///< 0.5 is a standard deviation squared
  double held_cost{0};  ///< the same with hand_from_eye held near the calibration
  /// Of the likelihood by letting go of the calibration, in chi2 of six degrees of freedom, widened
  /// alike.
  double gain{0};
  bool converged{false};  ///< also with hand_from_eye held, where anything hangs on it
  int iterations{0};
};

/// A bundle adjustment with the hand's poses in it (docs/math.md section 8) over a few seconds: the
/// hand gives the scale, so that it needs no reconstruction before it, nor parallax for the
/// rotation. Levenberg-Marquardt from `start`, to be compared with `calibrated`. Nothing where
/// there is too little to see.
std::optional<WatchFit> watch_fit(std::span<const WatchFrame> frames, const Pose& start,
                                  const Pose& calibrated, const WatchFitOptions& options);

/// Whether the hand and the images explain each other, at the answer that was found.
bool explains(const WatchFit& fit);

/// The same from starts all round the optical axis of `calibrated` - a camera head is turned about
/// it - and the best of them. Slower; for frames that `calibrated` itself does not explain.
std::optional<WatchFit> watch_search(std::span<const WatchFrame> frames, const Pose& calibrated,
                                     const WatchFitOptions& options);

}  // namespace handeye
