// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <semaphore>
#include <vector>

#include <boost/lockfree/spsc_queue.hpp>

namespace handeye {

/// Passes large reused objects (images, feature lists) from one thread to one other without
/// copying, locking or allocating: a fixed set of them circulates between "free" and "filled". When
/// the consumer falls behind, there is no free one and the producer drops, counted.
template <typename T>
class Exchange {
 public:
  explicit Exchange(std::size_t count) : items_(count), free_(count), filled_(count) {
    for (T& item : items_) free_.push(&item);
  }

  /// Producer: an object to write into, to be committed some time; null when all are filled or in
  /// use: then what should have gone into it is lost, and count_drop() is to be called.
  T* acquire() {
    T* item = nullptr;
    free_.pop(item);
    return item;
  }
  void count_drop() { dropped_.fetch_add(1, std::memory_order_relaxed); }
  /// Producer: hands over what acquire() gave.
  void commit(T* item) {
    filled_.push(item);
    ready_.release();
  }

  /// Consumer: the oldest filled object, waiting at most `timeout`; null when none came.
  T* take(std::chrono::milliseconds timeout) {
    T* item = nullptr;
    if (ready_.try_acquire_for(timeout)) filled_.pop(item);
    return item;
  }
  /// Consumer: how many are filled now.
  int waiting() const { return static_cast<int>(filled_.read_available()); }
  /// Consumer: gives back what take() gave.
  void release(T* item) { free_.push(item); }

  std::uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

 private:
  std::vector<T> items_;
  boost::lockfree::spsc_queue<T*> free_;
  boost::lockfree::spsc_queue<T*> filled_;
  std::counting_semaphore<> ready_{0};
  std::atomic<std::uint64_t> dropped_{0};
};

}  // namespace handeye
