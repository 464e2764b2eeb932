// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

#include "daemon/session/image_stage.hpp"

namespace handeye {

/// Reads a recording's images and works out what they show, on a thread of its own and a little
/// ahead of the one that asks: decoding and tracking take as long as reconstruction does. What is
/// handed out does not depend on which of the two is faster.
class TrackingAhead {
 public:
  /// Camera (opened) and stage are its own until it is destroyed. `check` may throw at a frame that
  /// cannot be used; next() then throws the same, after the frames before it.
  TrackingAhead(Camera& camera, ImageStage& images, std::function<void(const Frame&)> check);
  ~TrackingAhead();
  TrackingAhead(const TrackingAhead&) = delete;
  TrackingAhead& operator=(const TrackingAhead&) = delete;

  /// The next frame; false after the last. Throws what reading or tracking threw.
  bool next(TrackedFrame& tracked);

 private:
  void run(const std::stop_token& stop);
  void read_all(const std::stop_token& stop);
  bool hand_over(TrackedFrame& tracked, const std::stop_token& stop);

  Camera& camera_;
  ImageStage& images_;
  std::function<void(const Frame&)> check_;

  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<TrackedFrame> ready_;
  bool ended_{false};
  std::exception_ptr failure_;  ///< why it ended
  std::jthread thread_;         ///< last: it uses all of the above
};

}  // namespace handeye
