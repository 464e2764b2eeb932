// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace handeye {

/// A thread that does one piece of work at a time while its owner goes on. The owner alone decides
/// when it wants the result, so that what comes out does not depend on how fast the thread is.
class AdjustmentThread {
 public:
  AdjustmentThread() = default;
  ~AdjustmentThread();
  AdjustmentThread(const AdjustmentThread&) = delete;
  AdjustmentThread& operator=(const AdjustmentThread&) = delete;

  /// Begins with the work, which must not throw; the last must have been waited for.
  void begin(std::function<void()> work);

  /// Until the work that was begun is done; at once when there is none.
  void wait();

 private:
  void run();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::function<void()> work_;
  bool stopping_{false};
  std::thread thread_;  ///< begun with the first work: many reconstructions never need it
};

}  // namespace handeye
