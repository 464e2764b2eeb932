// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <boost/circular_buffer.hpp>
#include <handeye/camera_pose_t.hpp>
#include <handeye/status_t.hpp>

#include "daemon/handeye/types.hpp"
#include "daemon/sync/hand_prediction.hpp"
#include "daemon/sync/pose_buffer.hpp"
#include "protocol/bus.hpp"

namespace handeye {

/// The accepted calibration that CAMERA_POSE rests on.
struct ActiveCalibration {
  std::int64_t request_id{0};
  /// CLOCK_MONOTONIC; below 0: before the machine was started. Nothing: not known.
  std::optional<std::int64_t> accepted_ns;
  bool restored{false};  ///< by an earlier start of the daemon
  int body_id{0};
  Pose hand_from_eye{Pose::Identity()};
  Matrix6d covariance{Matrix6d::Zero()};  ///< of hand_from_eye, as in result_t
  std::int64_t time_offset_ns{0};         ///< camera stamp = tracker stamp + this
  double time_offset_sigma_s{0};
  HandSampleNoise hand_noise;  ///< of a sample that brings no covariance of its own
};

/// When a frame was taken, and its number.
struct FrameStamp {
  std::int64_t timestamp_ns{0};
  std::int64_t sequence{0};
  std::int64_t arrival_ns{0};  ///< when it was heard of
};

/// What the watch says of a calibration: one of status_t's WATCH constants.
struct WatchWord {
  std::int64_t request_id{0};
  std::int32_t state{status_t::WATCH_OFF};
};

struct PosePublisherOptions {
  /// How long a frame waits for the tracker's sample after it before the hand is predicted.
  std::int64_t wait_ns{20'000'000};
  /// How far beyond the newest sample at most; 0: never.
  std::int64_t predict_ns{60'000'000};
};

/// Covariance of room_from_eye = room_from_hand * hand_from_eye in the convention of camera_pose_t:
/// from the hand's, the calibration's, and the time offset's times the eye's velocity (its
/// correlation with hand_from_eye is left out).
Matrix6d camera_pose_covariance(const HandEstimate& hand, const ActiveCalibration& calibration);

/// Publishes room_from_eye for every frame, in their order, as soon as the tracker's samples around
/// it are there, or after a short wait with the hand predicted. A frame for which neither can be
/// had is published as invalid, never with an old pose. One thread; no allocation per frame.
class PosePublisher {
 public:
  PosePublisher(Bus& bus, const std::string& channel, const PosePublisherOptions& options = {});

  void use(const ActiveCalibration& calibration);
  const std::optional<ActiveCalibration>& calibration() const { return calibration_; }
  /// The last word counts; one about another calibration than that in use has no effect.
  void hear(const WatchWord& word);
  void add_hand(const HandSample& sample) { hand_.push(sample); }
  void add_frame(const FrameStamp& stamp);
  /// Publishes what can be, and what has waited too long.
  void publish_ready(std::int64_t now_ns);
  /// When publish_ready() is due again if no sample comes; nothing: no frame waits.
  std::optional<std::int64_t> due_ns(std::int64_t now_ns) const;

 private:
  bool publish_one(const FrameStamp& stamp, std::int64_t now_ns);
  std::optional<HandEstimate> predict(const FrameStamp& stamp, std::int64_t hand_ns,
                                      std::int64_t now_ns) const;
  void begin_message(const FrameStamp& stamp, std::int64_t now_ns);
  void write(const HandEstimate& hand);
  std::int32_t calibration_flags() const;

  PosePublisherOptions options_;
  Publisher<camera_pose_t> publisher_;
  std::optional<ActiveCalibration> calibration_;
  WatchWord watch_;
  PoseBuffer hand_;
  boost::circular_buffer<FrameStamp> pending_;
  camera_pose_t message_{};
};

}  // namespace handeye
