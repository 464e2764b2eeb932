// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/news.hpp"

#include <utility>

#include <fmt/format.h>

#include "daemon/service/journal.hpp"
#include "daemon/session/age_text.hpp"

namespace handeye {
namespace {

EventField request_field(std::int64_t request_id) {
  return {"REQUEST_ID", std::to_string(request_id)};
}

std::string_view state_word(std::int32_t device_state) {
  switch (device_state) {
    case device_status_t::SILENT:
      return "is silent";
    case device_status_t::FAILED:
      return "sends what cannot be used";
    default:
      return "is gone";
  }
}

}  // namespace

void log_started(const StartOptions& start) {
  log_event(Event::kCalibrationStarted,
            fmt::format(
                "calibration {}: collecting, body {}, {}, wanted sigma {} deg and {} mm, "
                "at most {} s",
                start.request_id, start.body_id, start.board ? to_string(*start.board) : "no board",
                start.wanted.rotation_deg, start.wanted.translation_mm, start.max_duration_s),
            {request_field(start.request_id), {"BODY_ID", std::to_string(start.body_id)}});
}

void log_result(const CalibrationResult& result) {
  switch (result.verdict) {
    case Verdict::kAccepted:
      return log_event(
          Event::kCalibrationAccepted,
          fmt::format("calibration {}: accepted, sigma {:.3f} deg and {:.3f} mm", result.request_id,
                      result.sigma_rotation_deg, result.sigma_translation_mm),
          {request_field(result.request_id)});
    case Verdict::kCancelled:
      return log_event(Event::kCalibrationCancelled,
                       fmt::format("calibration {}: cancelled", result.request_id),
                       {request_field(result.request_id)});
    case Verdict::kRefused:
      break;
  }
  const std::string reason(reason_word(result.reason));
  log_event(Event::kCalibrationRefused,
            fmt::format("calibration {}: refused, {}", result.request_id, reason),
            {request_field(result.request_id), {"REASON", reason}});
}

void log_restored(const CalibrationResult& result) {
  const auto age_s = result.vintage ? result.vintage->age_s : std::nullopt;
  log_event(Event::kCalibrationRestored,
            fmt::format("calibration {}: read back, {}; it goes on until there is a new one",
                        result.request_id, age_text(age_s)),
            {request_field(result.request_id),
             {"AGE_S", age_s ? fmt::format("{:.0f}", *age_s) : "unknown"}});
}

void log_holds(std::int64_t request_id) {
  log_event(Event::kWatchHolds,
            fmt::format("calibration {}: still holds, as live images show", request_id),
            {request_field(request_id)});
}

void log_not_used(const CalibrationResult& result, std::string_view reason) {
  log_event(Event::kCalibrationNotRestored,
            fmt::format("calibration {} was stored, but is not used: {}; calibrate again",
                        result.request_id, reason),
            {request_field(result.request_id)});
}

void DeviceNews::hear(const device_status_t& status) {
  const bool streams = status.state == device_status_t::STREAMING;
  if (std::exchange(streams_, streams) == streams) return;
  if (streams) {
    log_event(Event::kDeviceThere, fmt::format("the {} streams: {}", device_, status.text),
              {{"DEVICE", device_}});
  } else {
    log_event(Event::kDeviceLost,
              fmt::format("the {} {}: {}", device_, state_word(status.state), status.text),
              {{"DEVICE", device_}});
  }
}

}  // namespace handeye
