// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/background_thread.hpp"

#include <sys/resource.h>

#include <spdlog/spdlog.h>

#include "daemon/service/thread_role.hpp"

namespace handeye {

BackgroundThread::BackgroundThread(std::string name, int niceness)
    : thread_([this, name = std::move(name), niceness](const std::stop_token& stop) {
        take_role({.name = name});
        // On Linux, of this thread alone. It is a courtesy: without it everything still works.
        if (niceness > 0) setpriority(PRIO_PROCESS, 0, niceness);
        work(stop);
      }) {}

BackgroundThread::~BackgroundThread() = default;

bool BackgroundThread::busy() const {
  const std::scoped_lock lock(mutex_);
  return busy_;
}

void BackgroundThread::post(std::function<void()> job) {
  {
    const std::scoped_lock lock(mutex_);
    job_ = std::move(job);
    busy_ = true;
  }
  posted_.notify_one();
}

void BackgroundThread::work(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (posted_.wait(lock, stop, [this] { return static_cast<bool>(job_); })) {
    if (stop.stop_requested()) return;
    auto job = std::exchange(job_, nullptr);
    lock.unlock();
    heartbeat_.beat();
    job();
    job = nullptr;
    heartbeat_.rest();
    lock.lock();
    // The next one may have been posted since the answer was there.
    busy_ = static_cast<bool>(job_);
  }
}

void log_failure(std::string_view what, std::string_view why) {
  spdlog::error("{} failed: {}", what, why);
}

}  // namespace handeye
