// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <type_traits>
#include <utility>

#include "daemon/service/heartbeat.hpp"

namespace handeye {

/// One thread for work that is too slow for whoever needs it; one job at a time. A job whose future
/// is let go goes on to its end, and its answer is thrown away: a job owns what it works on.
class BackgroundThread {
 public:
  /// `name`: at most 15 characters. `niceness`: 0 as everybody, up to 19 yields to them.
  explicit BackgroundThread(std::string name = "background", int niceness = 0);
  /// Waits for the running job; one that waits is not begun.
  ~BackgroundThread();
  BackgroundThread(const BackgroundThread&) = delete;
  BackgroundThread& operator=(const BackgroundThread&) = delete;

  /// Beats when a job begins, rests when it is done.
  const Heartbeat& heartbeat() const { return heartbeat_; }

  /// Whether a job is waiting or running.
  bool busy() const;

  /// From one thread only: when not busy(), or when the answer of the last job has been seen.
  template <typename Job>
  std::future<std::invoke_result_t<Job>> run(Job job) {
    // std::function wants to be copied, a job need not be copyable.
    auto task = std::make_shared<std::packaged_task<std::invoke_result_t<Job>()>>(std::move(job));
    auto future = task->get_future();
    post([task = std::move(task)] { (*task)(); });
    return future;
  }

 private:
  void post(std::function<void()> job);
  void work(const std::stop_token& stop);

  Heartbeat heartbeat_;
  mutable std::mutex mutex_;
  std::condition_variable_any posted_;
  std::function<void()> job_;  ///< waiting
  bool busy_{false};
  std::jthread thread_;
};

void log_failure(std::string_view what, std::string_view why);

/// Whether there is an answer to be had without waiting.
template <typename T>
bool is_ready(const std::future<T>& future) {
  return future.valid() && future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

/// The answer of a job that is done. Nothing: it threw, which the log says of `what`.
template <typename T>
std::optional<T> outcome_of(std::future<T>& future, std::string_view what) {
  try {
    return future.get();
  } catch (const std::exception& error) {
    log_failure(what, error.what());
    return std::nullopt;
  }
}

}  // namespace handeye
