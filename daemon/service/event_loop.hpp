// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <csignal>
#include <functional>
#include <initializer_list>
#include <memory>
#include <vector>

#include <systemd/sd-event.h>

namespace handeye {

/// sd-event with RAII and callbacks; one thread. Throws InputError when the system refuses.
class EventLoop {
 public:
  EventLoop();
  ~EventLoop();
  EventLoop(const EventLoop&) = delete;
  EventLoop& operator=(const EventLoop&) = delete;

  /// Blocks the signals in this thread, and so in all threads started from now on; to be called
  /// before any thread starts.
  static void block_signals(std::initializer_list<int> signals);

  void on_signal(int signal, std::function<void()> callback);
  void on_readable(int file_descriptor, std::function<void()> callback);
  /// First after one period.
  void every(std::chrono::microseconds period, std::function<void()> callback);

  /// Returns after exit().
  void run();
  void exit();

 private:
  struct Source;

  void keep(std::unique_ptr<Source> source, int error, const char* what);

  sd_event* event_{nullptr};
  std::vector<std::unique_ptr<Source>> sources_;
};

}  // namespace handeye
