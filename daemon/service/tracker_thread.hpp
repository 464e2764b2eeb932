// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <handeye/body_t.hpp>
#include <handeye/datagram_t.hpp>
#include <handeye/tracker_frame_t.hpp>

#include "daemon/config/config.hpp"
#include "daemon/service/bounded_queue.hpp"
#include "daemon/service/device_health.hpp"
#include "daemon/service/hand_item.hpp"
#include "daemon/service/heartbeat.hpp"
#include "daemon/service/pose_publisher.hpp"
#include "daemon/service/wake_up.hpp"
#include "daemon/session/hand_stream.hpp"
#include "drivers/dtrack/receiver.hpp"
#include "drivers/dtrack/stream_monitor.hpp"
#include "protocol/channels.hpp"

namespace handeye {

/// Receives the tracker's datagrams, and everything that must follow at once: parses, maps to the
/// host's clock, publishes TRACKER (and DATAGRAM while recording), hands samples to the solver
/// while collecting, publishes CAMERA_POSE once calibrated. Never waits for anything but the
/// socket and the next frame.
class TrackerThread {
 public:
  /// Opens the socket, or takes the passed one over: throws InputError when the port is in use. The
  /// thread starts with start().
  TrackerThread(const Config::Tracker& config, const PosePublisherOptions& camera_poses, Bus& bus,
                const Channels& channels, std::optional<int> passed_socket = std::nullopt);

  void start(int realtime_priority = 0);

  /// From the main thread: samples of this body go to hand_samples() from now on, with that number.
  void begin_collecting(int body_id, std::uint64_t calibration);
  void end_collecting();
  /// From the main thread: publish CAMERA_POSE with this calibration.
  void use(const ActiveCalibration& calibration) { calibrations_.push(calibration); }
  /// From one thread: whether that calibration still holds. The flags of CAMERA_POSE follow it.
  void set_watch_state(const WatchWord& word) { watch_words_.push(word); }
  /// From the main thread: publish DATAGRAM until then.
  void record_until(std::int64_t monotonic_ns) { record_until_ns_ = monotonic_ns; }
  /// From the camera thread: a frame was taken.
  void frame_taken(FrameStamp stamp);

  /// The solver's end of the samples of the hand.
  BoundedQueue<HandItem>& hand_samples() { return hand_samples_; }
  /// The watch's end: of the calibrated body.
  BoundedQueue<WatchedHand>& watched_hand() { return watched_hand_; }
  const DeviceHealth& health() const { return health_; }
  /// Ids seen in the last datagram, "0 2".
  std::string tracked_bodies() const;
  std::uint16_t port() const { return receiver_.port(); }
  const Heartbeat& heartbeat() const { return heartbeat_; }

 private:
  /// What is wanted of the tracker, in one piece: no body's samples under another calibration.
  struct Collecting {
    std::uint32_t calibration{0};  ///< 0: none
    std::int32_t body_id{0};
  };
  static_assert(std::atomic<Collecting>::is_always_lock_free);

  void run(const std::stop_token& stop);
  void say_taken_over() const;
  void wait_for_work();
  void take(const Datagram& datagram);
  void count_datagram();
  void report_clock();
  static body_t body_message(const dtrack::Body& body);
  void publish_frame(const Datagram& datagram, const HandSample& sample);
  void publish_datagram(const Datagram& datagram);
  void distribute(const HandSample& sample, std::uint32_t collecting_for);

  Config::Tracker config_;
  dtrack::Receiver receiver_;
  dtrack::StreamMonitor monitor_;
  HandStream hand_stream_;
  Publisher<tracker_frame_t> frame_publisher_;
  Publisher<datagram_t> datagram_publisher_;
  PosePublisher pose_publisher_;
  tracker_frame_t frame_message_{};
  datagram_t datagram_message_{};

  DeviceHealth health_;
  std::int64_t clock_reported_ns_{0};
  std::int64_t jumps_{0};  ///< of the tracker's clock, as last said
  std::atomic<Collecting> collecting_;
  std::atomic<std::int64_t> record_until_ns_{0};
  std::atomic<std::uint64_t> tracked_bodies_{
      0};  ///< bit i: body i was tracked in the last datagram
  BoundedQueue<HandItem> hand_samples_;
  BoundedQueue<WatchedHand> watched_hand_;
  BoundedQueue<ActiveCalibration> calibrations_;
  BoundedQueue<WatchWord> watch_words_;
  BoundedQueue<FrameStamp> frame_stamps_;
  WakeUp frame_came_;
  Heartbeat heartbeat_;
  std::jthread thread_;
};

}  // namespace handeye
