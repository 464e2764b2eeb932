// SPDX-License-Identifier: BSD-3-Clause
#include "client/cli/status_text.hpp"

#include <optional>

#include <fmt/format.h>

#include "daemon/session/age_text.hpp"

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
  const std::string reordered =
      device.reordered > 0 ? fmt::format(", {} came out of order", device.reordered) : "";
  return fmt::format("{:<9}{}{:>8.1f}{:>10}{:>12}{:>9}{:>8}{:>11}{:>10}  {}{}\n", name,
                     colored_device_state(device.state, palette), device.rate_hz, age,
                     device.received, device.dropped, device.dropped_queue, device.malformed,
                     device.restarts, printable(device.text), reordered);
}

std::string uptime_text(double seconds) {
  const auto whole = static_cast<std::int64_t>(seconds);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string colored_clock_state(std::int32_t state, const Palette& palette) {
  const std::string word = fmt::format("{:<9}", clock_state_word(state));
  if (state == clock_status_t::STEADY) return palette.green(word);
  return state == clock_status_t::UNSTABLE ? palette.red(word) : palette.yellow(word);
}

/// Empty where the device has shown no time of its own and there is nothing to say about that.
std::string clock_text(std::string_view name, const clock_status_t& clock, const Palette& palette) {
  const std::string says = printable(clock.text);
  if (clock.state == clock_status_t::ABSENT) {
    return says.empty() ? "" : fmt::format("{:<16}{}\n", name, says);
  }
  std::string text = fmt::format("{:<16}{}drift {:+.1f} ppm, jitter {:.1f} ms, holds for {:.0f} s",
                                 name, colored_clock_state(clock.state, palette), clock.drift_ppm,
                                 clock.jitter_ms, clock.span_s);
  if (clock.jumps > 0) {
    text +=
        palette.yellow(fmt::format(", jumped {} time{}", clock.jumps, clock.jumps == 1 ? "" : "s"));
  }
  if (clock.midnights > 0) {
    text += fmt::format(", past midnight{}",
                        clock.midnights == 1 ? "" : fmt::format(" {} times", clock.midnights));
  }
  return text + (says.empty() ? "\n" : fmt::format("  {}\n", says));
}

/// The answer as it stands while collecting.
std::string estimate_text(const status_t& status) {
  if (!status.has_estimate) return "no estimate yet";
  const std::string position = fmt::format("estimate x {:.1f}  y {:.1f}  z {:.1f} mm",
                                           status.t_mm[0], status.t_mm[1], status.t_mm[2]);
  if (status.sigma_rotation_deg < 0) return position + ", uncertainty not known yet";
  return position + fmt::format(" +- {:.2f} mm, {:.2f} deg", status.sigma_translation_mm,
                                status.sigma_rotation_deg);
}

std::string time_offset_text(const status_t& status) {
  if (status.time_offset_sigma_s < 0) return "time offset not known yet";
  return fmt::format("time offset {:.1f} +- {:.1f} ms, confidence {:.0f} %",
                     1e3 * status.time_offset_s, 1e3 * status.time_offset_sigma_s,
                     100 * status.time_offset_confidence);
}

std::string turned_text(const status_t& status) {
  // About the camera's axes, so it takes an answer to tell.
  if (!status.has_estimate) return "turned: not known yet";
  return fmt::format("turned {:.1f} deg up and down, {:.1f} left and right, {:.1f} roll",
                     status.turned_deg[0], status.turned_deg[1], status.turned_deg[2]);
}

std::string calibrated_text(const status_t& status, const Palette& palette) {
  if (status.calibrated == 0) return "no";
  std::optional<double> age_s;
  if (status.calibration_age_s >= 0) age_s = status.calibration_age_s;
  const std::string text = palette.green("yes, CAMERA_POSE is published") + ", " + age_text(age_s);
  if (status.calibration_restored == 0) return text;
  return text + palette.yellow(", from before the daemon's restart: not seen to hold yet");
}

/// Whether the calibration in use still holds.
std::string watch_text(const status_t& status, const Palette& palette) {
  const std::string age = status.watch_age_s < 0
                              ? "never checked yet"
                              : fmt::format("checked {:.0f} s ago", status.watch_age_s);
  const std::string says = printable(status.watch_text);
  std::string text;
  switch (status.watch_state) {
    case status_t::WATCH_OFF:
      return "";
    case status_t::WATCH_HOLDS:
      text = fmt::format("{}, {}", palette.green("holds"), age);
      break;
    case status_t::WATCH_BROKEN:
      text = fmt::format("{}, {}", palette.red("NO LONGER HOLDS"), age);
      break;
    default:
      text = fmt::format("{}, {}", palette.yellow(watch_state_word(status.watch_state)), age);
  }
  if (!says.empty()) text += fmt::format("  {}", says);
  return fmt::format("calibration     {}\n", text);
}

}  // namespace

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
  text += '\n';
  text += clock_text("tracker clock", status.tracker.clock, palette);
  text += clock_text("camera clock", status.camera.clock, palette);
  text += fmt::format("bodies in view  {}\n", bodies.empty() ? "none" : bodies);
  text += fmt::format("session         {}\n", session_state_word(status.session_state));
  if (status.session_state == status_t::COLLECTING || status.session_state == status_t::SOLVING) {
    for (const std::string& line : {progress_text(status), estimate_text(status),
                                    time_offset_text(status), turned_text(status)}) {
      text += fmt::format("                {}\n", line);
    }
  }
  text += fmt::format("calibrated      {}\n", calibrated_text(status, palette));
  text += watch_text(status, palette);
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
