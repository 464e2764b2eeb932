// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/handeye/one_step/metric_scene.hpp"

namespace handeye {

/// The hand that the camera implies, room_from_eye * eye_from_hand, against the tracker's, in the
/// room: (w [rad], dt [mm]) with R_implied = Exp(w) R_tracker, t_implied = t_tracker + dt. So it is
/// the tracker's error, in its own terms, for which its rotation and its position are independent.
Vector6d hand_residual(const HandAtFrame& hand, const Pose& room_from_eye,
                       const MetricState& state);

/// How that changes with the steps of MetricState, to first order in the residual.
struct HandDerivatives {
  Matrix6d by_eye;            ///< (w, dC) of room_from_eye
  Matrix6d by_hand_from_eye;  ///< (w, dt)
  Vector6d by_time;
};
HandDerivatives hand_derivatives(const HandAtFrame& hand, const Pose& room_from_eye,
                                 const MetricState& state);

/// By how much each part's path has grown since the start.
std::vector<double> scales_since_start(const MetricScene& scene, const MetricState& state);

std::vector<Pose> eyes_at_start(const MetricScene& scene);

/// room_from_eye of every frame of the scene. A frame that is no keyframe goes where its part as a
/// whole went since the start (a similarity), and from there as the keyframes beside it do by sight
/// (sight.hpp), in shares: what resection saw between it and the structure is kept. Empty
/// `sighted`: where no frame follows.
std::vector<Pose> eyes_of_frames(const MetricScene& scene, const MetricState& state,
                                 const std::vector<Pose>& sighted_at_start,
                                 const std::vector<Pose>& sighted);

}  // namespace handeye
