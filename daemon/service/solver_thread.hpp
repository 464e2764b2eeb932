// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mutex>
#include <optional>
#include <thread>
#include <variant>

#include "daemon/service/background_thread.hpp"
#include "daemon/service/bounded_queue.hpp"
#include "daemon/service/exchange.hpp"
#include "daemon/service/hand_item.hpp"
#include "daemon/service/heartbeat.hpp"
#include "daemon/service/vision_thread.hpp"
#include "daemon/service/wake_up.hpp"
#include "daemon/session/calibration.hpp"
#include "daemon/session/progress.hpp"

namespace handeye {

/// Runs the calibrations: takes samples of the hand and tracked frames, hears requests, watches
/// sigma and the clock. What is slow is solved on threads behind it: provisional answers and
/// attempts at a final one from snapshots, so frames are taken in meanwhile; the global adjustment
/// takes the calibration itself away, and frames wait for it. Requests are heard all the time, and
/// within some 50 ms: a cancel is answered then, whatever is being solved; a finish is too, with
/// Solving, and the final answer begins when an adjustment that is under way is done. Taking in a
/// frame can last longer than that: see Calibration::add_frame().
class SolverThread {
 public:
  struct Options {
    CameraModel camera;  ///< without a focal length: nothing is known of the lens
    IntrinsicsMode intrinsics{IntrinsicsMode::kFixed};
    PoseNoise noise;
    HandNoiseSource hand_noise{HandNoiseSource::kMeasured};
    double min_duration_s{8};
  };

  /// What the main thread is told, in order. `Solving`, once, or never: no more frames are wanted,
  /// those tracked by then go in yet.
  struct Solving {};
  using Event = std::variant<Solving, CalibrationResult>;

  SolverThread(BoundedQueue<HandItem>& hand, Exchange<TrackedItem>& tracked,
               const Options& options);

  void start();

  /// From the main thread. `calibration`: the number that its samples and frames carry.
  void begin(const StartOptions& options, std::uint64_t calibration);
  void finish() { commands_.push({Command::Kind::kFinish, {}, 0}); }
  void cancel() { commands_.push({Command::Kind::kCancel, {}, 0}); }

  /// For the main thread: readable when next_event() has something.
  const WakeUp& wake_up() const { return wake_up_; }
  std::optional<Event> next_event() { return events_.pop(); }
  CalibrationProgress progress() const;

  const Heartbeat& heartbeat() const { return heartbeat_; }
  /// Of the threads behind it: attempts, and the final answer.
  const Heartbeat& attempts_heartbeat() const { return attempts_.heartbeat(); }
  const Heartbeat& final_answer_heartbeat() const { return final_answer_.heartbeat(); }

 private:
  struct Command {
    enum class Kind { kBegin, kFinish, kCancel } kind{Kind::kBegin};
    StartOptions start;
    std::uint64_t calibration{0};
  };
  struct Running;

  void run(const std::stop_token& stop);
  void forget_leftovers();
  void calibrate(const Command& begin, const std::stop_token& stop);
  void take_in(Running& running, std::chrono::milliseconds wait);
  void take_rest(Running& running, const std::stop_token& stop);
  void hear(Running& running);
  void tell_progress(Running& running);
  void tell_solving(Running& running);
  void begin_background_work(Running& running);
  bool end_background_work(Running& running);
  void end_provisional(Running& running);
  void end_adjustment(Running& running);
  bool end_attempt(Running& running);
  void conclude(Running& running, const std::stop_token& stop);
  std::optional<CalibrationResult> solve_finally(Running& running, const std::stop_token& stop);
  void post_result(const Running& running, CalibrationResult result);
  void post(Event event);

  BoundedQueue<HandItem>& hand_;
  Exchange<TrackedItem>& tracked_;
  Options options_;
  BoundedQueue<Command> commands_;
  BoundedQueue<Event> events_;
  WakeUp wake_up_;
  mutable std::mutex progress_mutex_;
  CalibrationProgress progress_;
  Heartbeat heartbeat_;
  BackgroundThread attempts_;
  BackgroundThread final_answer_;  ///< does not wait for what the other one is at
  std::jthread thread_;
};

}  // namespace handeye
