// SPDX-License-Identifier: BSD-3-Clause
#include "client/cli/status_text.hpp"

namespace handeye::cli {
namespace {

using Json = nlohmann::ordered_json;

/// The wire's -1 stands for "not known"; JSON has null for that.
Json known_or_null(double value) {
  return value < 0 ? Json(nullptr) : Json(value);
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
          {"restarts", device.restarts}};
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
          {"undecodable", status.undecodable}};
}

std::string dump_json(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace handeye::cli
