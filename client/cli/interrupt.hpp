// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

namespace handeye::cli {

/// Ctrl-C and SIGTERM as something to wait for instead of something that strikes. Construct it
/// before any thread is started (LCM starts one): threads inherit that the signals are blocked.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// Waits until `file_descriptor` is readable, a signal has come, or the time is over.
  /// True: a signal has come since the last call.
  bool wait(int file_descriptor, std::chrono::milliseconds timeout);

 private:
  int signals_;
};

}  // namespace handeye::cli
