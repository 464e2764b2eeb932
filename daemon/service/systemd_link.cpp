// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/systemd_link.hpp"

#include <cstdlib>
#include <string_view>
#include <sys/socket.h>

#include <fmt/format.h>
#include <systemd/sd-daemon.h>

#include "protocol/exit_codes.hpp"

namespace handeye {
namespace {

std::string_view session_text(std::int32_t session_state) {
  switch (session_state) {
    case status_t::COLLECTING:
      return "; collecting";
    case status_t::SOLVING:
      return "; solving";
    case status_t::REFUSED:
      return "; the last calibration was refused";
    case status_t::CANCELLED:
      return "; the last calibration was cancelled";
    default:
      return "";
  }
}

std::string_view calibration_text(const status_t& status) {
  if (status.calibrated == 0) return "not calibrated";
  if (status.watch_state == status_t::WATCH_BROKEN) return "the calibration no longer holds";
  if (status.watch_state == status_t::WATCH_DOUBTFUL) return "the calibration is doubtful";
  return status.calibration_restored != 0 ? "calibrated before the restart" : "calibrated";
}

/// Takes the names as FileDescriptorName= gives them over from the library.
std::string join_and_free(char** names, int count) {
  std::string text;
  for (int i = 0; names != nullptr && i < count; ++i) {
    if (i > 0) text += ", ";
    text += names[i];
    std::free(names[i]);
  }
  std::free(names);
  return text;
}

}  // namespace

std::optional<std::chrono::microseconds> SystemdLink::feeding_period() {
  std::uint64_t limit_us = 0;
  if (sd_watchdog_enabled(0, &limit_us) <= 0) return std::nullopt;
  return std::chrono::microseconds(limit_us / 3);
}

void SystemdLink::say_ready() {
  sd_notify(0, "READY=1");
}

void SystemdLink::say_stopping() {
  sd_notify(0, "STOPPING=1\nSTATUS=stopping");
}

void SystemdLink::feed_watchdog() {
  sd_notify(0, "WATCHDOG=1");
}

void SystemdLink::say_status(const std::string& text) {
  if (text == said_) return;
  said_ = text;
  sd_notify(0, ("STATUS=" + text).c_str());
}

std::string systemd_status(const status_t& status) {
  return fmt::format("tracker: {}; camera: {}; {}{}", status.tracker.text, status.camera.text,
                     calibration_text(status), session_text(status.session_state));
}

std::optional<int> passed_tracker_socket() {
  char** found = nullptr;
  // Its variables go: they are nobody else's business.
  const int count = sd_listen_fds_with_names(1, &found);
  const std::string names = join_and_free(found, count);
  if (count == 0) return std::nullopt;
  if (count < 0) throw InputError("the sockets that systemd passes cannot be taken over");
  if (count > 1) {
    throw UsageError(
        fmt::format("systemd passes {} sockets ({}), but only the tracker's UDP socket is wanted: "
                    "correct the .socket unit",
                    count, names));
  }
  if (sd_is_socket(SD_LISTEN_FDS_START, AF_INET, SOCK_DGRAM, -1) <= 0) {
    throw UsageError(
        fmt::format("the socket that systemd passes ({}) is no UDP socket of IPv4: say "
                    "ListenDatagram=0.0.0.0:PORT in the .socket unit",
                    names));
  }
  return SD_LISTEN_FDS_START;
}

}  // namespace handeye
