// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include <handeye/status_t.hpp>

namespace handeye {

/// What systemd is told (sd_notify); nothing where the daemon runs without it. One thread.
class SystemdLink {
 public:
  /// How often the watchdog is to be fed: a third of WatchdogSec=. Nothing: it is off.
  static std::optional<std::chrono::microseconds> feeding_period();

  static void say_ready();
  static void say_stopping();
  static void feed_watchdog();
  /// The text in `systemctl status`; sent only when it has changed.
  void say_status(const std::string& text);

 private:
  std::string said_;
};

/// One line for `systemctl status`, of what does not change all the time: devices, session,
/// calibration.
std::string systemd_status(const status_t& status);

/// The descriptor of the one UDP socket that systemd opened for the tracker; nothing: none, the
/// daemon opens its own. Throws UsageError for any other kind, or number, of sockets: the units are
/// wrong.
std::optional<int> passed_tracker_socket();

}  // namespace handeye
