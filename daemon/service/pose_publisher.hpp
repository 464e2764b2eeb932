// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <boost/circular_buffer.hpp>
#include <handeye/camera_pose_t.hpp>

#include "daemon/handeye/types.hpp"
#include "daemon/sync/pose_buffer.hpp"
#include "protocol/bus.hpp"

namespace handeye {

/// The accepted calibration that CAMERA_POSE rests on.
struct ActiveCalibration {
  std::int64_t request_id{0};
  std::int64_t accepted_ns{0};  ///< CLOCK_MONOTONIC
  int body_id{0};
  Pose hand_from_eye{Pose::Identity()};
  Matrix6d covariance{Matrix6d::Zero()};  ///< of hand_from_eye, as in result_t
  std::int64_t time_offset_ns{0};         ///< camera stamp = tracker stamp + this
  double hand_rotation_sigma_rad{0};      ///< of a tracker pose, per axis
  double hand_translation_sigma_mm{0};
};

/// When a frame was taken, and its number.
struct FrameStamp {
  std::int64_t timestamp_ns{0};
  std::int64_t sequence{0};
};

/// Covariance of room_from_eye = room_from_hand * hand_from_eye from both factors, in the
/// convention of camera_pose_t; the hand's noise is taken as isotropic.
Matrix6d camera_pose_covariance(const Pose& room_from_hand, const ActiveCalibration& calibration);

/// Publishes room_from_eye for every frame, as soon as the tracker's samples around it are there; a
/// frame whose samples do not come is published as invalid, never with an old pose. One thread.
class PosePublisher {
 public:
  PosePublisher(Bus& bus, const std::string& channel);

  void use(const ActiveCalibration& calibration);
  const std::optional<ActiveCalibration>& calibration() const { return calibration_; }
  void add_hand(const HandSample& sample) { hand_.push(sample); }
  void add_frame(const FrameStamp& stamp);
  /// Publishes what can be, and what has waited too long.
  void publish_ready(std::int64_t now_ns);

 private:
  bool publish_one(const FrameStamp& stamp, std::int64_t now_ns);

  Publisher<camera_pose_t> publisher_;
  std::optional<ActiveCalibration> calibration_;
  PoseBuffer hand_;
  boost::circular_buffer<FrameStamp> pending_;
  camera_pose_t message_{};
};

}  // namespace handeye
