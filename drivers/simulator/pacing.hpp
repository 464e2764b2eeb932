// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <stop_token>
#include <utility>

namespace handeye::simulator {

/// Sleeps until the host's CLOCK_MONOTONIC reaches `wake_ns`. False: told to stop before that
/// (noticed within 20 ms).
bool sleep_until(std::int64_t wake_ns, const std::stop_token& stop);

/// Hands things from one thread to another, in order. Bounded by what circulates: an empty one goes
/// back through a second handover.
template <typename T>
class Handover {
 public:
  void put(T item) {
    {
      const std::lock_guard lock(mutex_);
      items_.push_back(std::move(item));
    }
    changed_.notify_one();
  }

  /// No more will come.
  void close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    changed_.notify_all();
  }

  /// Waits for the next item; nothing when closed and empty, or told to stop.
  std::optional<T> take(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, stop, [this] { return closed_ || !items_.empty(); });
    if (stop.stop_requested() || items_.empty()) return std::nullopt;
    std::optional<T> item(std::move(items_.front()));
    items_.pop_front();
    return item;
  }

 private:
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<T> items_;
  bool closed_{false};
};

}  // namespace handeye::simulator
