// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <handeye/image_t.hpp>

#include "daemon/service/exchange.hpp"
#include "daemon/service/heartbeat.hpp"
#include "daemon/session/image_health.hpp"
#include "daemon/session/image_stage.hpp"
#include "daemon/tracking/image_inspector.hpp"
#include "drivers/camera.hpp"
#include "protocol/bus.hpp"

namespace handeye {

/// A tracked frame on its way to the solver.
struct TrackedItem {
  std::uint64_t calibration{0};  ///< which begin_collecting() it belongs to
  TrackedFrame frame;
  double tracking_ms{0};  ///< spent so far in this calibration
};

/// Takes frames from the camera; while recording publishes those of a camera that is not on LCM
/// already; while collecting tracks features, or finds a board's corners, and hands them to the
/// solver. In between tracks for the watch over the calibration in use, as far as there is time.
class VisionThread {
 public:
  struct Options {
    cv::Mat mask;                     ///< empty: found in the images
    std::optional<CameraModel> lens;  ///< where it is known before a calibration
    std::optional<std::string>
        frame_channel;  ///< where to publish frames while recording; none: never
    /// Waiting for the solver, which may be busy for many seconds: 17 s of a 60 Hz camera. Feature
    /// lists are small.
    std::size_t tracked_in_flight{1024};
  };

  VisionThread(Exchange<Frame>& frames, Bus& bus, Options options);

  void start();

  /// From the main thread: looks for a board, or, without one, follows features. Returns the number
  /// that the TrackedItems of this calibration will carry.
  std::uint64_t begin_collecting(const std::optional<Board>& board);
  void end_collecting() { collecting_ = 0; }
  /// From the main thread: while nothing is collected, track for the watch over a calibration that
  /// used or found this lens.
  void begin_watching(const CameraModel& lens);
  void record_until(std::int64_t monotonic_ns) { record_until_ns_ = monotonic_ns; }

  /// The solver's end of the tracked frames.
  Exchange<TrackedItem>& tracked() { return tracked_; }
  /// The watch's end; TrackedItem::calibration is new whenever features are numbered anew.
  Exchange<TrackedItem>& watched() { return watched_; }
  int features_tracked() const { return features_tracked_; }
  std::int64_t frames_collected() const { return frames_collected_; }
  /// What ails most of the last images, while collecting or not; kInterlaced: nothing else does.
  ImageCondition picture() const { return picture_; }
  const Heartbeat& heartbeat() const { return heartbeat_; }

 private:
  void run(const std::stop_token& stop);
  void begin_stage(std::uint64_t calibration);
  ImageCondition track(const Frame& frame, std::uint64_t calibration);
  bool is_watch_due(const Frame& frame) const;
  ImageCondition track_for_watch(const Frame& frame);
  ImageCondition look(const Frame& frame);
  void catch_up_on_descriptions(TrackedFrame& tracked);
  void report_picture();
  void process(const Frame& frame, TrackedFrame& tracked);
  void publish(const Frame& frame);

  Exchange<Frame>& frames_;
  Options options_;
  std::optional<Publisher<image_t>> publisher_;
  image_t message_{};
  std::vector<int> jpeg_options_;

  std::unique_ptr<ImageStage> stage_;
  std::uint64_t staged_calibration_{0};
  TrackedFrame overflow_;
  std::vector<FeatureDescription> missed_descriptions_;  ///< of frames that went to overflow_
  ImageInspector inspector_;                             ///< while nothing is being tracked
  ImageHealth health_;
  bool interlaced_{false};  ///< as last seen: only while tracking can it be told

  std::unique_ptr<ImageStage> watch_stage_;
  std::uint64_t watch_tracking_{0};
  std::int64_t next_watch_ns_{0};
  TrackedFrame watch_overflow_;

  std::uint64_t last_calibration_{0};
  std::mutex begin_mutex_;  ///< taken when a calibration, or the watch over it, begins
  std::optional<Board> board_;
  std::optional<CameraModel> watched_lens_;
  std::atomic<std::uint64_t> collecting_{0};  ///< the running calibration's number; 0: none
  std::atomic<bool> watching_{false};
  std::atomic<std::int64_t> record_until_ns_{0};
  std::atomic<int> features_tracked_{0};
  std::atomic<std::int64_t> frames_collected_{0};
  std::atomic<ImageCondition> picture_{ImageCondition::kGood};
  Exchange<TrackedItem> tracked_;
  Exchange<TrackedItem> watched_;
  Heartbeat heartbeat_;
  std::jthread thread_;
};

}  // namespace handeye
