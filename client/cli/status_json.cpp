// SPDX-License-Identifier: BSD-3-Clause
#include "client/cli/status_text.hpp"

namespace handeye::cli {
namespace {

using Json = nlohmann::ordered_json;

/// The wire's -1 stands for "not known"; JSON has null for that.
Json known_or_null(double value) {
  return value < 0 ? Json(nullptr) : Json(value);
}

Json clock_json(const clock_status_t& clock) {
  return {{"state", clock_state_word(clock.state)},
          {"text", clock.text},
          {"drift_ppm", clock.drift_ppm},
          {"jitter_ms", clock.jitter_ms},
          {"span_s", clock.span_s},
          {"jumps", clock.jumps},
          {"midnights", clock.midnights}};
}

Json device_json(const device_status_t& device) {
  return {{"state", device_state_word(device.state)},
          {"text", device.text},
          {"rate_hz", device.rate_hz},
          {"age_s", known_or_null(device.age_s)},
          {"received", device.received},
          {"dropped", device.dropped},
          {"dropped_queue", device.dropped_queue},
          {"malformed", device.malformed},
          {"restarts", device.restarts},
          {"reordered", device.reordered},
          {"clock", clock_json(device.clock)}};
}

/// The answer as it stands while collecting; null: none yet.
Json estimate_json(const status_t& status) {
  if (!status.has_estimate) return nullptr;
  return {{"q_wxyz", status.q_wxyz}, {"t_mm", status.t_mm}};
}

Json time_offset_json(const status_t& status) {
  if (status.time_offset_sigma_s < 0) return nullptr;
  return {{"time_offset_s", status.time_offset_s},
          {"sigma_s", status.time_offset_sigma_s},
          {"confidence", status.time_offset_confidence}};
}

Json watch_json(const status_t& status) {
  return {{"state", watch_state_word(status.watch_state)},
          {"text", status.watch_text},
          {"deviation_deg", status.watch_deviation_deg},
          {"deviation_sigma_deg", known_or_null(status.watch_deviation_sigma_deg)},
          {"age_s", known_or_null(status.watch_age_s)}};
}

Json session_json(const status_t& status) {
  return {{"state", session_state_word(status.session_state)},
          {"request_id", status.request_id},
          {"elapsed_s", status.elapsed_s},
          {"max_duration_s", status.max_duration_s},
          {"progress", status.progress},
          {"sigma_rotation_deg", known_or_null(status.sigma_rotation_deg)},
          {"sigma_translation_mm", known_or_null(status.sigma_translation_mm)},
          {"wanted_sigma",
           {{"rotation_deg", status.wanted_sigma_rotation_deg},
            {"translation_mm", status.wanted_sigma_translation_mm}}},
          {"features_tracked", status.features_tracked},
          {"frames_collected", status.frames_collected},
          {"keyframes", status.keyframes},
          {"rotation_coverage_deg", status.rotation_coverage_deg},
          {"translation_coverage_mm", status.translation_coverage_mm},
          {"turned_deg", status.turned_deg},
          {"hand_from_eye", estimate_json(status)},
          {"time_offset", time_offset_json(status)},
          {"guidance_code", guide_word(status.guidance_code)},
          {"guidance", status.guidance}};
}

}  // namespace

Json status_json(const status_t& status) {
  return {{"utime", status.utime},
          {"session_id", status.session_id},
          {"seq", status.seq},
          {"protocol_version", status.protocol_version},
          {"software_version", status.software_version},
          {"uptime_s", status.uptime_s},
          {"tracker", device_json(status.tracker)},
          {"camera", device_json(status.camera)},
          {"tracked_bodies", status.tracked_bodies},
          {"session", session_json(status)},
          {"calibrated", status.calibrated != 0},
          {"calibration_request_id", status.calibration_request_id},
          {"calibration_age_s", known_or_null(status.calibration_age_s)},
          {"calibration_restored", status.calibration_restored != 0},
          {"watch", watch_json(status)},
          {"undecodable", status.undecodable}};
}

std::string dump_json(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace handeye::cli
