// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "daemon/handeye/one_step/one_step.hpp"

namespace handeye {

/// What `one_step` minimises over: everything in the room and mm, counted from the scene's centre.
struct MetricState {
  Pose hand_from_eye{Pose::Identity()};
  double time_offset_s{0};  ///< correction; a larger one means that the hand was measured earlier
  CameraModel camera;
  std::vector<Pose> room_from_eye;         ///< of each keyframe
  std::vector<Eigen::Vector3d> points_mm;  ///< in the room
};

/// Steps of the unknowns but the points: of every keyframe (w [rad], dC [mm]) in the room, R of
/// room_from_eye <- Exp(w) R, its translation C <- C + dC; then what all frames have in common.
inline constexpr Eigen::Index kEyeUnknowns = 6;
inline constexpr Eigen::Index kCommonUnknowns = 13;  ///< X (w, dt), time offset [s], lens
inline constexpr Eigen::Index kTimeInCommon = 6;
inline constexpr Eigen::Index kLensInCommon = 7;
using CommonVector = Eigen::Matrix<double, kCommonUnknowns, 1>;
using CommonMatrix = Eigen::Matrix<double, kCommonUnknowns, kCommonUnknowns>;

inline Eigen::Index unknowns_of_eye(std::size_t keyframe) {
  return kEyeUnknowns * static_cast<Eigen::Index>(keyframe);
}

/// `step`: of keyframes and common unknowns; `point_steps_mm`: one a point.
MetricState moved_by(const MetricState& state, const Eigen::VectorXd& step,
                     const std::vector<Eigen::Vector3d>& point_steps_mm);

struct MetricObservation {
  std::size_t keyframe{0};  ///< position in MetricState::room_from_eye
  Eigen::Vector2d pixel;
};

/// A frame that is in use.
struct MetricFrame {
  std::size_t frame{0};  ///< position in OneStepProblem::frames
  std::size_t part{0};   ///< position in MetricScene::keyframes_of_parts
  bool keyframe{false};
  /// The keyframes that it moves with, by the shares 1 - b and b; a keyframe only with itself, one
  /// that is none with them by sight (sight.hpp).
  std::size_t before{0}, after{0};
  double share{0};                             ///< b, 0..1
  Pose room_from_eye_start{Pose::Identity()};  ///< where the start places it
  Matrix6d unit_covariance{Matrix6d::Zero()};  ///< of (w, dC) there at 1 px; 0: a keyframe
  std::optional<HandAtFrame> hand;             ///< its room counted from the scene's centre
};

/// What was measured, and where it starts.
struct MetricScene {
  Eigen::Vector3d centre_mm{Eigen::Vector3d::Zero()};  ///< in the room
  std::vector<MetricFrame> frames;                     ///< in order of time
  std::vector<std::vector<std::size_t>> keyframes_of_parts;
  std::vector<Pose> keyframes_at_start;         ///< room_from_eye
  std::vector<MetricObservation> observations;  ///< point by point
  std::vector<std::size_t> first_of_point;      ///< in `observations`; one more than points
  MetricState start;

  bool has_followers() const { return frames.size() > keyframes_at_start.size(); }
  std::size_t keyframes() const { return keyframes_at_start.size(); }
  std::size_t points() const { return start.points_mm.size(); }
  Eigen::Index common_at() const { return unknowns_of_eye(keyframes()); }
  Eigen::Index unknowns() const { return common_at() + kCommonUnknowns; }
};

/// Places frames and points in the room as `start` says. Left out are parts that it did not use,
/// keyframes that see too few points, and points that are seen too seldom or without parallax.
/// Nothing where numbers are not finite or too little is left.
std::optional<MetricScene> metric_scene(const OneStepProblem& problem,
                                        const MaximumLikelihoodResult& start);

}  // namespace handeye
