// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "daemon/service/bounded_queue.hpp"
#include "daemon/service/exchange.hpp"
#include "daemon/service/hand_item.hpp"
#include "daemon/service/heartbeat.hpp"
#include "daemon/service/vision_thread.hpp"
#include "daemon/session/calibration_watch.hpp"

namespace handeye {

/// Watches over the calibration in use, behind everything else: takes what the vision thread
/// tracked meanwhile and the hand's samples, and lets a CalibrationWatch judge them. Yields to the
/// other threads; what it has no time for is dropped.
class WatchThread {
 public:
  /// Told, from this thread, of every change of state: the calibration's request and the state.
  /// Must not call back.
  using Listener = std::function<void(std::int64_t request_id, WatchState state)>;

  WatchThread(BoundedQueue<WatchedHand>& hand_samples, Exchange<TrackedItem>& tracked,
              Listener listener);

  void start();

  /// From the main thread: watch this one from now on. After it the listener hears of no other.
  void watch(std::int64_t request_id, const WatchedCalibration& calibration);

  /// `now_ns`: CLOCK_MONOTONIC.
  WatchStatus status(std::int64_t now_ns) const;
  const Heartbeat& heartbeat() const { return heartbeat_; }

 private:
  struct Task {
    std::int64_t request_id{0};
    WatchedCalibration calibration;
  };

  void run(const std::stop_token& stop);
  void begin(const Task& task);
  void take_in(TrackedItem& item);
  void tell();

  BoundedQueue<WatchedHand>& hand_samples_;
  Exchange<TrackedItem>& tracked_;
  Listener listener_;
  BoundedQueue<Task> tasks_;
  std::int64_t request_id_{0};
  std::uint64_t tracking_{0};  ///< TrackedItem::calibration of the last one
  std::unique_ptr<CalibrationWatch> watch_;
  mutable std::mutex status_mutex_;
  std::int64_t in_use_{0};  ///< the calibration that was asked for last
  WatchStatus status_;      ///< as of status_at_ns_
  std::int64_t status_at_ns_{0};
  Heartbeat heartbeat_;
  std::jthread thread_;
};

}  // namespace handeye
