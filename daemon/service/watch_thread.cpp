// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/watch_thread.hpp"

#include <sys/resource.h>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>

#include "daemon/service/journal.hpp"
#include "daemon/service/thread_role.hpp"
#include "protocol/bus.hpp"

namespace handeye {
namespace {

constexpr std::chrono::milliseconds kWait{100};
constexpr int kNiceness = 5;

}  // namespace

WatchThread::WatchThread(BoundedQueue<WatchedHand>& hand_samples, Exchange<TrackedItem>& tracked,
                         Listener listener)
    : hand_samples_(hand_samples), tracked_(tracked), listener_(std::move(listener)), tasks_(4) {}

void WatchThread::start() {
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void WatchThread::watch(std::int64_t request_id, const WatchedCalibration& calibration) {
  {
    const std::scoped_lock lock(status_mutex_);
    in_use_ = request_id;
    status_ = {};
  }
  tasks_.push({request_id, calibration});
}

void WatchThread::run(const std::stop_token& stop) {
  take_role({.name = "watch"});
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNiceness);
  while (!stop.stop_requested()) {
    heartbeat_.beat();
    TrackedItem* item = tracked_.take(kWait);
    while (const auto task = tasks_.pop()) begin(*task);
    while (const auto hand = hand_samples_.pop()) {
      if (watch_ && hand->request_id == request_id_) watch_->add_hand(hand->sample);
    }
    if (item != nullptr) {
      if (watch_) take_in(*item);
      tracked_.release(item);
    }
    tell();
  }
}

void WatchThread::begin(const Task& task) {
  request_id_ = task.request_id;
  watch_ = std::make_unique<CalibrationWatch>(task.calibration);
}

void WatchThread::take_in(TrackedItem& item) {
  if (std::exchange(tracking_, item.calibration) != item.calibration) watch_->forget_features();
  watch_->add_frame(item.frame);
}

void WatchThread::tell() {
  if (!watch_) return;
  const std::int64_t now_ns = monotonic_ns();
  const WatchStatus now = watch_->status(now_ns);
  WatchState before{};
  {
    // The listener within, so that nobody hears of a calibration after another came into use.
    const std::scoped_lock lock(status_mutex_);
    if (request_id_ != in_use_) return;
    before = std::exchange(status_, now).state;
    status_at_ns_ = now_ns;
    if (before == now.state) return;
    listener_(request_id_, now.state);
  }
  if (now.state == WatchState::kBroken) {
    log_event(Event::kWatchBroken, fmt::format("calibration {}: {}", request_id_, now.text),
              {{"REQUEST_ID", std::to_string(request_id_)}});
  } else if (before == WatchState::kBroken) {
    log_event(Event::kWatchHolds, fmt::format("calibration {}: holds again", request_id_),
              {{"REQUEST_ID", std::to_string(request_id_)}});
  }
}

WatchStatus WatchThread::status(std::int64_t now_ns) const {
  const std::scoped_lock lock(status_mutex_);
  WatchStatus status = status_;
  if (status.age_s >= 0) status.age_s += 1e-9 * static_cast<double>(now_ns - status_at_ns_);
  return status;
}

}  // namespace handeye
