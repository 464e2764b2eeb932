// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/service/device_health.hpp"
#include "daemon/service/exchange.hpp"
#include "daemon/service/heartbeat.hpp"
#include "daemon/service/pose_publisher.hpp"
#include "daemon/sync/frame_clock.hpp"
#include "drivers/camera.hpp"

namespace handeye {

/// Keeps the camera open, whatever happens to it, and hands its frames on: opens, grabs, and after
/// a loss opens again; after a failure, and where not one frame came, with growing pauses. Frames
/// that are not of the intrinsics' size are refused, as are those of which nobody knows when they
/// were taken (FrameClock).
class CameraThread {
 public:
  using FrameTaken = std::function<void(const FrameStamp&)>;

  /// `frame_taken` is called in the camera's thread for every good frame.
  CameraThread(std::unique_ptr<Camera> camera, const CameraModel& model, FrameTaken frame_taken);

  void start(int realtime_priority = 0);

  /// The consumer's end of the frames.
  Exchange<Frame>& frames() { return frames_; }
  const DeviceHealth& health() const { return health_; }
  const Heartbeat& heartbeat() const { return heartbeat_; }

 private:
  void run(const std::stop_token& stop);
  bool open();
  bool stream(const std::stop_token& stop);
  void lose(bool delivered);
  void fail(const std::string& problem);
  void hand_on(const Frame& frame);
  bool has_right_size(const Frame& frame) const;
  void say(bool usable, const Frame& frame);
  bool stamp(Frame& frame);
  void report_clock(std::int64_t now_ns);
  void count();

  std::unique_ptr<Camera> camera_;
  CameraModel model_;
  FrameTaken frame_taken_;
  Exchange<Frame> frames_;
  Frame* next_{nullptr};  ///< acquired, to be filled next; null: all are with the consumer
  Frame overflow_;        ///< filled then instead: received, and dropped
  DeviceHealth health_;
  std::string last_problem_;      ///< as last logged
  bool delivers_nothing_{false};  ///< was lost before its first frame
  FrameClock clock_;
  std::int64_t clock_reported_ns_{0};
  std::int64_t jumps_{0};  ///< of the camera's clock, as last said
  std::int64_t wrong_size_{0};
  std::int64_t wrong_time_{0};
  Heartbeat heartbeat_;
  std::jthread thread_;
};

}  // namespace handeye
