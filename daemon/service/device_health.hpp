// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <utility>

#include <handeye/device_status_t.hpp>

#include "daemon/sync/clock_report.hpp"

namespace handeye {

/// What a device's thread says about it, for STATUS: counters are atomic, the text changes rarely.
class DeviceHealth {
 public:
  std::atomic<std::int64_t> received{0};
  std::atomic<std::int64_t> dropped{0};
  std::atomic<std::int64_t> dropped_queue{0};
  std::atomic<std::int64_t> malformed{0};
  std::atomic<std::int64_t> restarts{0};
  std::atomic<std::int64_t> reordered{0};
  std::atomic<std::int64_t> last_ns{0};  ///< CLOCK_MONOTONIC of the last datum; 0: none yet

  /// `state`: a constant of device_status_t; `text`: one line for a person.
  void set(std::int32_t state, std::string text) {
    const std::scoped_lock lock(mutex_);
    state_ = state;
    text_ = std::move(text);
  }
  std::pair<std::int32_t, std::string> state() const {
    const std::scoped_lock lock(mutex_);
    return {state_, text_};
  }

  /// From the device's thread; some ten times a second suffice.
  void set_clock(const ClockReport& clock) {
    const std::scoped_lock lock(mutex_);
    clock_ = clock;
  }
  ClockReport clock() const {
    const std::scoped_lock lock(mutex_);
    return clock_;
  }

 private:
  mutable std::mutex mutex_;
  ClockReport clock_;
  std::int32_t state_{device_status_t::WAITING};
  std::string text_;
};

/// In the words of STATUS.
clock_status_t clock_status(const ClockReport& report);

/// Turns a DeviceHealth into device_status_t, five times a second: adds rate, age and silence.
class DeviceStatusReporter {
 public:
  /// A device that streamed and then says nothing for so long is SILENT.
  explicit DeviceStatusReporter(double silent_after_s) : silent_after_s_(silent_after_s) {}

  device_status_t report(const DeviceHealth& health, std::int64_t now_ns);

 private:
  double silent_after_s_;
  std::deque<std::pair<std::int64_t, std::int64_t>> history_;  ///< (time [ns], received)
};

}  // namespace handeye
