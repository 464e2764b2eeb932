// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <variant>

#include "daemon/service/bounded_queue.hpp"
#include "daemon/service/exchange.hpp"
#include "daemon/service/vision_thread.hpp"
#include "daemon/service/wake_up.hpp"
#include "daemon/session/calibration.hpp"

namespace handeye {

/// Runs the calibrations: takes samples of the hand and tracked frames, watches sigma and the
/// clock, solves. Everything slow happens here, and nothing else does.
class SolverThread {
 public:
  struct Options {
    CameraModel camera;  ///< without a focal length: nothing is known of the lens
    IntrinsicsMode intrinsics{IntrinsicsMode::kFixed};
    PoseNoise noise;
    double min_duration_s{8};
  };

  /// What the main thread is told, in order. `Solving`: the last frame has been taken.
  struct Solving {};
  using Event = std::variant<Solving, CalibrationResult>;

  SolverThread(BoundedQueue<HandSample>& hand_samples, Exchange<TrackedItem>& tracked,
               const Options& options);

  void start();

  /// From the main thread. `calibration` as VisionThread::begin_collecting() returned it.
  void begin(const StartOptions& options, std::uint64_t calibration);
  void finish() { commands_.push({Command::Kind::kFinish, {}, 0}); }
  void cancel() { commands_.push({Command::Kind::kCancel, {}, 0}); }

  /// For the main thread: readable when next_event() has something.
  const WakeUp& wake_up() const { return wake_up_; }
  std::optional<Event> next_event() { return events_.pop(); }
  CalibrationProgress progress() const;

 private:
  struct Command {
    enum class Kind { kBegin, kFinish, kCancel } kind{Kind::kBegin};
    StartOptions start;
    std::uint64_t calibration{0};
  };
  struct Running;

  void run(const std::stop_token& stop);
  void calibrate(const Command& begin, const std::stop_token& stop);
  void take_in(Running& running, std::chrono::milliseconds wait);
  void take_rest(Running& running, const std::stop_token& stop);
  void hear(Running& running);
  bool assess(Running& running);
  void conclude(Running& running, const std::stop_token& stop);
  CalibrationResult solve(Running& running);
  void post(Event event);
  void set_progress(CalibrationProgress progress);

  BoundedQueue<HandSample>& hand_samples_;
  Exchange<TrackedItem>& tracked_;
  Options options_;
  BoundedQueue<Command> commands_;
  BoundedQueue<Event> events_;
  WakeUp wake_up_;
  mutable std::mutex progress_mutex_;
  CalibrationProgress progress_;
  std::jthread thread_;
};

}  // namespace handeye
