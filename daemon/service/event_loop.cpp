// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/event_loop.hpp"

#include <cstring>
#include <ctime>
#include <sys/epoll.h>

#include <fmt/format.h>

#include "protocol/exit_codes.hpp"

namespace handeye {

struct EventLoop::Source {
  std::function<void()> callback;
  std::uint64_t period_us{0};
  sd_event_source* source{nullptr};

  Source(std::function<void()> on_event, std::uint64_t period)
      : callback(std::move(on_event)), period_us(period) {}
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  ~Source() { sd_event_source_unref(source); }
};

namespace {

void require(int error, const char* what) {
  if (error < 0) throw InputError(fmt::format("event loop: {}: {}", what, std::strerror(-error)));
}

}  // namespace

EventLoop::EventLoop() {
  require(sd_event_new(&event_), "cannot be created");
}

EventLoop::~EventLoop() {
  sources_.clear();
  sd_event_unref(event_);
}

void EventLoop::block_signals(std::initializer_list<int> signals) {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : signals) sigaddset(&set, signal);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

void EventLoop::on_signal(int signal, std::function<void()> callback) {
  auto source = std::make_unique<Source>(std::move(callback), 0);
  const auto call = [](sd_event_source*, const signalfd_siginfo*, void* data) {
    static_cast<Source*>(data)->callback();
    return 0;
  };
  const int error = sd_event_add_signal(event_, &source->source, signal, call, source.get());
  keep(std::move(source), error, "signal");
}

void EventLoop::on_readable(int file_descriptor, std::function<void()> callback) {
  auto source = std::make_unique<Source>(std::move(callback), 0);
  const auto call = [](sd_event_source*, int, std::uint32_t, void* data) {
    static_cast<Source*>(data)->callback();
    return 0;
  };
  const int error =
      sd_event_add_io(event_, &source->source, file_descriptor, EPOLLIN, call, source.get());
  keep(std::move(source), error, "file descriptor");
}

void EventLoop::every(std::chrono::microseconds period, std::function<void()> callback) {
  auto source =
      std::make_unique<Source>(std::move(callback), static_cast<std::uint64_t>(period.count()));
  const auto call = [](sd_event_source* timer, std::uint64_t due_us, void* data) {
    auto* self = static_cast<Source*>(data);
    self->callback();
    // From the time that was due, not from now: the rate does not drift.
    sd_event_source_set_time(timer, due_us + self->period_us);
    return sd_event_source_set_enabled(timer, SD_EVENT_ONESHOT);
  };
  const int error = sd_event_add_time_relative(event_, &source->source, CLOCK_MONOTONIC,
                                               source->period_us, 1000, call, source.get());
  keep(std::move(source), error, "timer");
}

void EventLoop::keep(std::unique_ptr<Source> source, int error, const char* what) {
  require(error, what);
  sources_.push_back(std::move(source));
}

void EventLoop::run() {
  require(sd_event_loop(event_), "run");
}

void EventLoop::exit() {
  sd_event_exit(event_, 0);
}

}  // namespace handeye
