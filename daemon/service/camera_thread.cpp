// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/camera_thread.hpp"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <optional>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "daemon/service/thread_role.hpp"
#include "protocol/bus.hpp"

namespace handeye {
namespace {

using std::chrono::milliseconds;

// Room for the vision thread to be busy for a quarter of a second at 30 Hz.
constexpr std::size_t kFramesInFlight = 8;
constexpr milliseconds kGrabTimeout{200};
constexpr milliseconds kFirstPause{250};
constexpr milliseconds kLongestPause{2000};
// STATUS goes out five times a second.
constexpr std::int64_t kClockReportPeriod_ns = 100'000'000;

/// Sleeps, but not beyond a request to stop.
void pause(const std::stop_token& stop, milliseconds duration) {
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  wake.wait_for(lock, stop, duration, [] { return false; });
}

}  // namespace

CameraThread::CameraThread(std::unique_ptr<Camera> camera, const CameraModel& model,
                           FrameTaken frame_taken)
    : camera_(std::move(camera)),
      model_(model),
      frame_taken_(std::move(frame_taken)),
      frames_(kFramesInFlight) {
  health_.set(device_status_t::WAITING, camera_->description());
}

void CameraThread::start(int realtime_priority) {
  thread_ = std::jthread([this, realtime_priority](const std::stop_token& stop) {
    take_role({"camera", realtime_priority});
    run(stop);
  });
}

void CameraThread::run(const std::stop_token& stop) {
  milliseconds wait = kFirstPause;
  while (!stop.stop_requested()) {
    const bool delivered = open() && stream(stop);
    camera_->close();
    if (delivered) {
      wait = kFirstPause;
      continue;
    }
    pause(stop, wait);
    wait = std::min(2 * wait, kLongestPause);
  }
}

/// Tries once.
bool CameraThread::open() {
  heartbeat_.beat();
  if (const auto problem = camera_->open()) {
    delivers_nothing_ = false;
    fail(*problem);
    return false;
  }
  health_.set(device_status_t::WAITING, fmt::format("{}: no frame yet", camera_->description()));
  // What was lost before its first frame is likely to be so again.
  if (!delivers_nothing_) spdlog::info("camera: opened {}", camera_->description());
  return true;
}

/// Until the camera is lost; true: it has delivered a frame, of whatever use.
bool CameraThread::stream(const std::stop_token& stop) {
  std::optional<bool> said_usable;
  bool delivered = false;
  clock_.restart();
  while (!stop.stop_requested()) {
    heartbeat_.beat();
    if (next_ == nullptr) next_ = frames_.acquire();
    Frame& frame = next_ != nullptr ? *next_ : overflow_;
    const GrabStatus status = camera_->grab(frame, kGrabTimeout);
    count();
    if (status == GrabStatus::kLost || status == GrabStatus::kEnd) {
      lose(delivered);
      break;
    }
    if (status != GrabStatus::kFrame) continue;
    if (delivers_nothing_) spdlog::info("camera: {} delivers", camera_->description());
    delivers_nothing_ = false;
    delivered = true;
    const bool usable = has_right_size(frame);
    // Said when it changes, not with every frame.
    if (said_usable != usable) say(usable, frame);
    said_usable = usable;
    if (!usable) {
      ++wrong_size_;
      continue;
    }
    health_.last_ns = monotonic_ns();
    if (stamp(frame)) {
      hand_on(frame);
    } else {
      ++wrong_time_;
    }
    report_clock(health_.last_ns);
  }
  return delivered;
}

void CameraThread::lose(bool delivered) {
  if (!delivered) {
    delivers_nothing_ = true;
    fail(fmt::format("{}: lost before its first frame, trying again", camera_->description()));
    return;
  }
  last_problem_.clear();
  spdlog::debug("camera: lost {}", camera_->description());
  health_.set(device_status_t::ABSENT,
              fmt::format("{}: lost, trying again", camera_->description()));
}

/// Logged once, not at every attempt.
void CameraThread::fail(const std::string& problem) {
  if (problem != last_problem_) spdlog::warn("camera: {}", problem);
  last_problem_ = problem;
  health_.set(device_status_t::ABSENT, problem);
}

/// Puts the time of the host's clock into the frame; false: it is not known.
bool CameraThread::stamp(Frame& frame) {
  const FrameTime time = clock_.observe(frame.timestamp_ns, frame.arrival_ns, frame.sequence);
  frame.timestamp_ns = time.timestamp_ns;
  return !time.doubtful;
}

void CameraThread::report_clock(std::int64_t now_ns) {
  if (now_ns - clock_reported_ns_ < kClockReportPeriod_ns) return;
  clock_reported_ns_ = now_ns;
  const ClockReport report = clock_.report();
  health_.set_clock(report);
  if (report.jumps != jumps_) spdlog::warn("camera: the clock of its time stamps has jumped");
  jumps_ = report.jumps;
}

void CameraThread::hand_on(const Frame& frame) {
  frame_taken_({frame.timestamp_ns, frame.sequence});
  if (next_ != nullptr) {
    frames_.commit(next_);
    next_ = nullptr;
  } else {
    frames_.count_drop();
  }
}

bool CameraThread::has_right_size(const Frame& frame) const {
  return frame.grey.cols == model_.width && frame.grey.rows == model_.height;
}

void CameraThread::say(bool usable, const Frame& frame) {
  if (usable) {
    health_.set(device_status_t::STREAMING, camera_->description());
    return;
  }
  const std::string text = fmt::format(
      "{}: sends {}x{}, but the intrinsics are for {}x{}; change one of them",
      camera_->description(), frame.grey.cols, frame.grey.rows, model_.width, model_.height);
  // Logged once: two senders on one channel would take turns.
  if (wrong_size_ == 0) spdlog::error("camera: {}", text);
  health_.set(device_status_t::FAILED, text);
}

void CameraThread::count() {
  const CameraCounters counters = camera_->counters();
  health_.received = static_cast<std::int64_t>(counters.received);
  health_.dropped = static_cast<std::int64_t>(counters.dropped);
  health_.malformed = static_cast<std::int64_t>(counters.malformed) + wrong_size_ + wrong_time_;
  health_.restarts = counters.opened > 0 ? static_cast<std::int64_t>(counters.opened) - 1 : 0;
  health_.dropped_queue = static_cast<std::int64_t>(counters.dropped_queue + frames_.dropped());
}

}  // namespace handeye
