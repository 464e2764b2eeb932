// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>

namespace handeye {

/// A thread's proof that it makes progress: it beats with every round of its loop, and rests while
/// it waits without a limit. Costs an atomic increment; knows no clock.
class Heartbeat {
 public:
  void beat() {
    beats_.fetch_add(1, std::memory_order_relaxed);
    resting_.store(false, std::memory_order_relaxed);
  }
  /// Nothing is expected until the next beat. So it begins, and so it ends.
  void rest() { resting_.store(true, std::memory_order_relaxed); }

  std::uint64_t beats() const { return beats_.load(std::memory_order_relaxed); }
  bool resting() const { return resting_.load(std::memory_order_relaxed); }

 private:
  std::atomic<std::uint64_t> beats_{0};
  std::atomic<bool> resting_{true};
};

}  // namespace handeye
