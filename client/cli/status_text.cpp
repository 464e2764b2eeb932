// SPDX-License-Identifier: BSD-3-Clause
#include "client/cli/status_text.hpp"

#include <fmt/format.h>

namespace handeye::cli {
namespace {

std::string sigma_text(double sigma, double wanted, std::string_view unit) {
  const std::string so_far = sigma < 0 ? "?" : fmt::format("{:.2f}", sigma);
  return fmt::format("{}/{:.3g} {}", so_far, wanted, unit);
}

std::string colored_device_state(std::int32_t state, const Palette& palette) {
  const std::string word = fmt::format("{:<11}", device_state_word(state));
  if (state == device_status_t::STREAMING) return palette.green(word);
  return state == device_status_t::FAILED ? palette.red(word) : palette.yellow(word);
}

std::string device_text(std::string_view name, const device_status_t& device,
                        const Palette& palette) {
  const std::string age = device.age_s < 0 ? "never" : fmt::format("{:.2f} s", device.age_s);
  return fmt::format("{:<9}{}{:>8.1f}{:>10}{:>12}{:>9}{:>8}{:>11}{:>10}  {}\n", name,
                     colored_device_state(device.state, palette), device.rate_hz, age,
                     device.received, device.dropped, device.dropped_queue, device.malformed,
                     device.restarts, printable(device.text));
}

std::string uptime_text(double seconds) {
  const auto whole = static_cast<std::int64_t>(seconds);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

}  // namespace

std::string session_state_word(std::int32_t state) {
  switch (state) {
    case status_t::IDLE:
      return "idle";
    case status_t::COLLECTING:
      return "collecting";
    case status_t::SOLVING:
      return "solving";
    case status_t::DONE:
      return "done";
    case status_t::REFUSED:
      return "refused";
    case status_t::CANCELLED:
      return "cancelled";
    default:
      return fmt::format("state {}", state);
  }
}

std::string device_state_word(std::int32_t state) {
  switch (state) {
    case device_status_t::ABSENT:
      return "absent";
    case device_status_t::WAITING:
      return "waiting";
    case device_status_t::STREAMING:
      return "streaming";
    case device_status_t::SILENT:
      return "silent";
    case device_status_t::FAILED:
      return "failed";
    default:
      return fmt::format("state {}", state);
  }
}

std::string status_text(const status_t& status, const Palette& palette) {
  std::string text = palette.bold(fmt::format("handeyed {}", printable(status.software_version))) +
                     fmt::format(", up {} (h:mm:ss)\n\n", uptime_text(status.uptime_s));
  text += palette.bold(fmt::format("{:<9}{:<11}{:>8}{:>10}{:>12}{:>9}{:>8}{:>11}{:>10}", "device",
                                   "state", "Hz", "age", "received", "dropped", "queue",
                                   "malformed", "restarts")) +
          "\n";
  text += device_text("tracker", status.tracker, palette);
  text += device_text("camera", status.camera, palette);
  const std::string bodies = printable(status.tracked_bodies);
  text += fmt::format("\nbodies in view  {}\n", bodies.empty() ? "none" : bodies);
  text += fmt::format("session         {}\n", session_state_word(status.session_state));
  if (status.session_state == status_t::COLLECTING || status.session_state == status_t::SOLVING) {
    text += fmt::format("                {}\n", progress_text(status));
  }
  text += fmt::format("calibrated      {}\n",
                      status.calibrated ? palette.green("yes, CAMERA_POSE is published") : "no");
  if (status.undecodable > 0) {
    text += palette.yellow(fmt::format("{} messages on the daemon's channels were not of its types",
                                       status.undecodable)) +
            "\n";
  }
  return text;
}

std::string progress_text(const status_t& status) {
  if (status.session_state == status_t::SOLVING) return "solving ...";
  // What to do stands before the figures: a narrow terminal cuts the end off.
  std::string text =
      fmt::format("{} {:3.0f} %  ", progress_bar(status.progress, 12), 100 * status.progress);
  if (!status.guidance.empty()) text += printable(status.guidance) + "  ";
  return text +
         fmt::format(
             "({}, {}, {:.0f} s)",
             sigma_text(status.sigma_rotation_deg, status.wanted_sigma_rotation_deg, "deg"),
             sigma_text(status.sigma_translation_mm, status.wanted_sigma_translation_mm, "mm"),
             status.elapsed_s);
}

}  // namespace handeye::cli
