// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <sys/eventfd.h>
#include <unistd.h>

namespace handeye {

/// Lets any thread wake the event loop: an eventfd.
class WakeUp {
 public:
  WakeUp() : file_descriptor_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}
  ~WakeUp() { close(file_descriptor_); }
  WakeUp(const WakeUp&) = delete;
  WakeUp& operator=(const WakeUp&) = delete;

  int file_descriptor() const { return file_descriptor_; }

  void signal() const {
    const std::uint64_t one = 1;
    // The counter cannot overflow in practice; a failed write leaves it readable anyway.
    [[maybe_unused]] const auto written = write(file_descriptor_, &one, sizeof one);
  }
  void clear() const {
    std::uint64_t count = 0;
    [[maybe_unused]] const auto got = read(file_descriptor_, &count, sizeof count);
  }

 private:
  int file_descriptor_;
};

}  // namespace handeye
