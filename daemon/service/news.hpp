// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <handeye/device_status_t.hpp>

#include "daemon/session/result.hpp"
#include "daemon/session/session.hpp"

namespace handeye {

// What the main thread has to tell the log: see Event in journal.hpp.

void log_started(const StartOptions& start);
void log_result(const CalibrationResult& result);
void log_restored(const CalibrationResult& result);
/// It has been seen to hold for the first time since.
void log_holds(std::int64_t request_id);
/// It was stored, and cannot be used; why not.
void log_not_used(const CalibrationResult& result, std::string_view reason);

/// Tells the log when a device comes and goes.
class DeviceNews {
 public:
  /// `device`: "tracker".
  explicit DeviceNews(std::string device) : device_(std::move(device)) {}

  /// With every STATUS.
  void hear(const device_status_t& status);

 private:
  std::string device_;
  bool streams_{false};
};

}  // namespace handeye
