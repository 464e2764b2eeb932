// SPDX-License-Identifier: BSD-3-Clause
#include "client/cli/solve_json.hpp"

#include "daemon/session/result_json.hpp"

namespace handeye::cli {
namespace {

using Json = nlohmann::ordered_json;

Json device_json(double rotation_rad, double translation_mm) {
  return {{"rotation_deg", deg_from_rad(rotation_rad)}, {"translation_mm", translation_mm}};
}

Json noise_json(const PoseSolution& solution) {
  const PoseNoise& noise = solution.noise;
  const bool estimated = solution.noise_estimated;
  // Nobody has estimated anything where there is no answer.
  if (estimated && !solution.calibration.has_estimate) return nullptr;
  return {{"hand", device_json(noise.hand_rotation_rad, noise.hand_translation_mm)},
          {"eye", device_json(noise.eye_rotation_rad, noise.eye_translation_mm)},
          {"source", estimated ? "estimated" : "given"},
          {"exceeded_by", solution.noise_factor}};
}

/// Counted from 1, as people count rows.
Json rows_of(const std::vector<std::size_t>& poses) {
  Json rows = Json::array();
  for (const std::size_t pose : poses) rows.push_back(pose + 1);
  return rows;
}

}  // namespace

Json solve_json(const PoseSolution& solution) {
  Json json = to_json(solution.calibration);
  for (const char* field : {"request_id", "body_id", "eye", "camera", "frames", "features"}) {
    json[field] = nullptr;
  }
  json["residuals"]["reprojection_px"] = nullptr;
  if (!solution.calibration.has_estimate) json["residuals"] = nullptr;
  json["timings_ms"]["tracking"] = nullptr;
  json["timings_ms"]["reconstruction"] = nullptr;
  json["scale"] = solution.scale == ScaleMode::kKnown ? "known" : "unknown";
  json["poses"] = {{"received", solution.poses},
                   {"used", solution.poses_used},
                   {"wrong_rows", rows_of(solution.wrong_poses)},
                   {"rejected_rows", rows_of(solution.rejected_poses)}};
  json["noise"] = noise_json(solution);
  return json;
}

}  // namespace handeye::cli
