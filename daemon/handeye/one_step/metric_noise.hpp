// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "daemon/handeye/one_step/metric_scene.hpp"

namespace handeye {

/// Standard deviations per axis, and how they differ from track to track.
struct MetricNoise {
  double image_px{0};
  double hand_rotation_rad{0};    ///< of one sample of the tracker
  double hand_translation_mm{0};  ///< likewise
  /// What each point's observations count for (track_weights.hpp); empty: all alike.
  std::vector<double> track_weights;
};

/// What the samples' shares leave of the variance of one: between two (1-a)^2 + a^2.
double interpolated_variance(const HandAtFrame& hand);

/// Covariance of (w, dt) of one sample, in the room; `measured`: as the tracker itself says, where
/// it does.
Matrix6d sample_covariance(const HandAtFrame& hand, const MetricNoise& noise, bool measured);

/// The noise of a frame's own resection at 1 px, as one of the hand residual; `scale`: of its part
/// since the start, for what was seen in the scene's units grows with the scene.
Matrix6d eye_noise_at_hand(const MetricFrame& frame, const Pose& room_from_eye,
                           const MetricState& state, double scale);

/// How a frame's hand residual is weighed: the inverse root L^-1 of its covariance L L^T, which is
/// the tracker's noise, interpolated, and that of the frame's own resection.
struct HandWeights {
  std::vector<Matrix6d> whitenings;  ///< one a frame of the scene; 0 where there is no hand
};
HandWeights hand_weights(const MetricScene& scene, const std::vector<Pose>& eyes,
                         const MetricState& state, const MetricNoise& noise, bool measured);

}  // namespace handeye
