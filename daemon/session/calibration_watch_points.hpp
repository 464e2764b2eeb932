// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "daemon/session/calibration_watch_unknowns.hpp"

namespace handeye {

/// What is assumed of the inverse depths of a scene [1/mm]. A point that may come as near as it
/// likes follows anything: some hundredths of a millimetre by which the eyes are off are enough to
/// explain a feature that slides, and the eyes go with it.
struct WatchDepth {
  double usual{0.01};
  double sigma{0.03};
  double least{2e-4};
  double largest{0.3};
};

/// Standard deviations that residuals are weighed with.
struct WatchWeights {
  double image{0.001};         ///< of a ray, per axis, at focal length 1
  double robust_image{0.004};  ///< where the loss bends (Cauchy), likewise; 0: least squares
  WatchDepth depth;
  double time_offset_s{0.002};  ///< of the correction before the data
  // What the motion does not tell stays where it started; what it tells is not touched.
  double hold_rotation_rad{0.3};
  double hold_translation_mm{30.0};
};

/// A point's ray in an eye. Nothing: not before it.
std::optional<Eigen::Vector2d> watch_ray(const WatchTrack& track, const Pose& room_from_eye);

/// What the images say about one feature, in units of half a squared standard deviation.
double watch_track_cost(const WatchTrack& track, const std::vector<Pose>& room_from_eye,
                        const WatchWeights& weights);

/// One sight of a point, to first order.
struct WatchSighted {
  Eigen::Vector2d residual{Eigen::Vector2d::Zero()};
  double weight{0};
  Eigen::Matrix<double, 2, 6> by_pose;  ///< (w [rad], dc [mm]) of room_from_eye
  Eigen::Matrix<double, 2, 3> by_point;
  /// A shift of the eye counts the more the nearer the point: change of by_point's depth per mm.
  Eigen::Matrix<double, 2, 3> depth_by_shift;
};

/// Nothing where the point is not before the eye.
std::optional<WatchSighted> watch_sighted(const WatchTrack& track, const WatchTrack::Sight& sight,
                                          const Pose& room_from_eye, const WatchWeights& weights);

/// Normal equations of a point alone, before its sights.
struct WatchPointEquations {
  Eigen::Matrix3d normal{Eigen::Matrix3d::Zero()};
  Eigen::Vector3d right{Eigen::Vector3d::Zero()};

  WatchPointEquations(const WatchTrack& track, const WatchDepth& depth);
  void add(const WatchSighted& sighted);
  /// At an end of its range, pulled beyond, the depth is no unknown. Returns whether it is so.
  bool stay_within(const WatchTrack& track, const WatchDepth& depth);
};

/// Adjusts the points alone to the eyes as they are. The elimination is then exact also for a long
/// step: together with hand_from_eye the whole scene turns, which points in the room follow badly
/// to first order.
void settle_points(const WatchWeights& weights, WatchUnknowns& unknowns);

/// Trusts each sight from here on as the loss does now: what goes on choosing which sights to
/// believe comes to its end slowly, and two fits can be compared only if they believe the same.
void freeze_trust(const WatchWeights& weights, WatchUnknowns& unknowns);

}  // namespace handeye
