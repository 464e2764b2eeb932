// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "daemon/geometry/pose.hpp"
#include "daemon/sync/hand_course.hpp"
#include "daemon/sync/pose_buffer.hpp"

namespace handeye {

/// Noise of one tracker sample, standard deviations per axis; for samples that bring no covariance
/// of their own.
struct HandSampleNoise {
  double rotation_rad{0};
  double translation_mm{0};
};

/// The covariance of (w [rad], dt [mm]) in the room that this noise makes of a sample.
Matrix6d hand_sample_covariance(const HandSampleNoise& noise);

/// The hand at an instant, wherever that comes from: between two samples or beyond the last one.
struct HandEstimate {
  Pose room_from_hand{Pose::Identity()};
  /// Of (w [rad], dt [mm]) in the room: R = Exp(w) R_estimate, t = t_estimate + dt.
  Matrix6d covariance{Matrix6d::Zero()};
  Eigen::Vector3d angular_velocity{Eigen::Vector3d::Zero()};  ///< in the room [rad/s]
  Eigen::Vector3d velocity{Eigen::Vector3d::Zero()};  ///< of the hand's origin, in the room [mm/s]
  double predicted_s{0};                              ///< beyond the newest sample; 0: between two
};

/// What a look-up that is kOk knows, with the noise that interpolation leaves: (1-a)^2 + a^2 of one
/// sample's (docs/math.md section 8).
HandEstimate interpolated_hand(const HandLookup& found, const HandSampleNoise& noise);

struct HandPredictionOptions {
  HandCourseOptions course;
  /// The hand's jerk, which a course leaves out, is at least that of a sway of this angular
  /// frequency through the velocity and acceleration seen ...
  double sway_rad_per_s{3.0};
  /// ... or of this one, as long as too little was seen to know better: a shaky hand's.
  double shaky_sway_rad_per_s{11.0};
  /// ... and at least what predictions as far ahead would have missed by in this time, or the
  /// longer one that a slow tracker needs for so many.
  std::int64_t hindsight_ns{500'000'000};
  int least_hindsights{10};  ///< at least 5
  std::int64_t longest_hindsight_ns{1'200'000'000};
};

/// Where the hand is at `timestamp_ns`, beyond the newest sample: its course carried on. The
/// covariance is that of the samples' noise, carried along, and of the jerk. A tracker from 10 Hz
/// on will do: the slower, the longer the course and the wider the claim. Nothing where the newest
/// sample is hidden, or too few since a gap, a hidden sample or a clock's jump. No allocation; some
/// tens of microseconds.
std::optional<HandEstimate> predict_hand(const PoseBuffer& samples, std::int64_t timestamp_ns,
                                         const HandSampleNoise& noise,
                                         const HandPredictionOptions& options = {});

}  // namespace handeye
