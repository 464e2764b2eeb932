// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/tracking_ahead.hpp"

#include <utility>

namespace handeye {
namespace {

// Enough to bridge an adjustment of some hundred milliseconds.
constexpr std::size_t kMostReady = 64;

}  // namespace

TrackingAhead::TrackingAhead(Camera& camera, ImageStage& images,
                             std::function<void(const Frame&)> check)
    : camera_(camera),
      images_(images),
      check_(std::move(check)),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

TrackingAhead::~TrackingAhead() = default;

bool TrackingAhead::next(TrackedFrame& tracked) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !ready_.empty() || ended_; });
  if (ready_.empty()) {
    if (failure_) std::rethrow_exception(failure_);
    return false;
  }
  tracked = std::move(ready_.front());
  ready_.pop_front();
  lock.unlock();
  changed_.notify_all();
  return true;
}

void TrackingAhead::run(const std::stop_token& stop) {
  std::exception_ptr failure;
  try {
    read_all(stop);
  } catch (...) {
    failure = std::current_exception();
  }
  {
    const std::scoped_lock lock(mutex_);
    failure_ = failure;
    ended_ = true;
  }
  changed_.notify_all();
}

void TrackingAhead::read_all(const std::stop_token& stop) {
  Frame frame;
  while (camera_.grab(frame, std::chrono::milliseconds(0)) == GrabStatus::kFrame) {
    check_(frame);
    TrackedFrame tracked;
    images_.process(frame, tracked);
    if (!hand_over(tracked, stop)) return;
  }
}

bool TrackingAhead::hand_over(TrackedFrame& tracked, const std::stop_token& stop) {
  {
    std::unique_lock lock(mutex_);
    if (!changed_.wait(lock, stop, [this] { return ready_.size() < kMostReady; })) return false;
    ready_.push_back(std::move(tracked));
  }
  changed_.notify_all();
  return true;
}

}  // namespace handeye
