// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <semaphore>

#include <boost/lockfree/spsc_queue.hpp>

namespace handeye {

/// Hands values from one thread to one other without locks. Full: the new value is dropped and
/// counted, the producer never waits. No allocation after construction beyond the values' own.
template <typename T>
class BoundedQueue {
 public:
  explicit BoundedQueue(std::size_t capacity) : queue_(capacity) {}

  /// Producer. False: full; the value was dropped and counted.
  bool push(T value) {
    if (!queue_.push(std::move(value))) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
    filled_.release();
    return true;
  }

  /// Consumer. Waits at most `timeout` for a value.
  std::optional<T> pop(std::chrono::milliseconds timeout = std::chrono::milliseconds(0)) {
    if (!filled_.try_acquire_for(timeout)) return std::nullopt;
    T value;
    if (!queue_.pop(value)) return std::nullopt;
    return value;
  }

  /// Consumer. Forgets what waits, from before the call.
  void clear() {
    while (pop()) {
    }
  }

  std::uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

 private:
  boost::lockfree::spsc_queue<T> queue_;
  std::counting_semaphore<> filled_{0};
  std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace handeye
