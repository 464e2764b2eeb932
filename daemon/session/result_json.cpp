// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/result_json.hpp"

#include <cmath>

namespace handeye {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json number(const std::optional<double>& value) {
  return value ? number(*value) : Json(nullptr);
}

std::string_view verdict_word(Verdict verdict) {
  switch (verdict) {
    case Verdict::kAccepted:
      return "accepted";
    case Verdict::kRefused:
      return "refused";
    case Verdict::kCancelled:
      return "cancelled";
  }
  return "refused";
}

Json lens_sigma_json(const LensSigma& sigma) {
  return {{"focal_px", number(sigma.focal_px)},
          {"centre_px", number(sigma.centre_px)},
          {"k1", number(sigma.k1)},
          {"k2", number(sigma.k2)},
          {"distortion_px", number(sigma.distortion_px)}};
}

Json camera_json(const CalibrationResult& result) {
  const CameraModel& camera = result.camera;
  Json json{{"width", camera.width},
            {"height", camera.height},
            {"fx", camera.fx},
            {"fy", camera.fy},
            {"cx", camera.cx},
            {"cy", camera.cy},
            {"distortion", camera.distortion},
            {"source", result.camera_source}};
  if (result.lens) {
    json["sigma"] = lens_sigma_json(result.lens->sigma);
    json["observable"] = result.lens->observable;
  }
  return json;
}

Json residuals_json(const Residuals& residuals) {
  return {{"rotation_deg", number(residuals.rotation_deg)},
          {"rotation_percent", number(residuals.rotation_percent)},
          {"translation_percent", number(residuals.translation_percent)},
          {"translation_norm_percent", number(residuals.translation_norm_percent)}};
}

Json covariance_json(const Matrix6d& covariance) {
  Json rows = Json::array();
  for (int row = 0; row < 6; ++row) {
    Json values = Json::array();
    for (int column = 0; column < 6; ++column) values.push_back(number(covariance(row, column)));
    rows.push_back(std::move(values));
  }
  return rows;
}

Json method_json(const MethodResult& method) {
  Json json{{"name", method.name}};
  json["hand_from_eye"] =
      method.solution ? pose_json(method.solution->hand_from_eye) : Json(nullptr);
  json["scale_units_per_mm"] =
      method.solution ? number(method.solution->scale_units_per_mm) : Json(nullptr);
  json["residuals"] = method.solution ? residuals_json(method.residuals) : Json(nullptr);
  json["time_ms"] = number(method.time_ms);
  if (method.sigma) {
    json["sigma"] = {{"rotation_deg", number(method.sigma->rotation_deg)},
                     {"translation_mm", number(method.sigma->translation_mm)}};
  }
  return json;
}

/// By what the answer was weighted; null where that is not known.
void add_noise(Json& json, const CalibrationResult& result) {
  json["hand_noise"] = nullptr;
  if (result.hand_noise) {
    json["hand_noise"] = {{"rotation_deg", number(result.hand_noise->rotation_deg)},
                          {"translation_mm", number(result.hand_noise->translation_mm)},
                          {"source", result.hand_noise->source}};
  }
  json["image_noise_px"] =
      result.image_noise_px > 0 ? number(result.image_noise_px) : Json(nullptr);
}

/// A word, or null where there is none.
Json word_or_null(std::string_view word) {
  return word.empty() ? Json(nullptr) : Json(word);
}

/// The estimate and what speaks for it; all null where there is none.
void add_estimate(Json& json, const CalibrationResult& result) {
  const bool has = result.has_estimate;
  json["method"] = has ? word_or_null(result.method) : Json(nullptr);
  json["hand_from_eye"] = has ? pose_json(result.solution.hand_from_eye) : Json(nullptr);
  json["covariance"] = has ? covariance_json(result.covariance) : Json(nullptr);
  json["sigma_rotation_deg"] = has ? number(result.sigma_rotation_deg) : Json(nullptr);
  json["sigma_translation_mm"] = has ? number(result.sigma_translation_mm) : Json(nullptr);
  json["time_offset_s"] = number(result.time_offset_s);
  json["time_offset_sigma_s"] = number(result.time_offset_sigma_s);
  json["scale_units_per_mm"] = has ? number(result.solution.scale_units_per_mm) : Json(nullptr);
}

}  // namespace

Json pose_json(const Pose& pose) {
  Eigen::Quaterniond q(pose.linear());
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const Eigen::Vector3d& t = pose.translation();
  return {{"q_wxyz", {q.w(), q.x(), q.y(), q.z()}}, {"t_mm", {t.x(), t.y(), t.z()}}};
}

Json to_json(const CalibrationResult& result) {
  Json json;
  json["verdict"] = verdict_word(result.verdict);
  json["reason"] =
      result.reason == Reason::kNone ? Json(nullptr) : Json(reason_word(result.reason));
  json["advice"] = result.advice;
  json["missing"] = word_or_null(result.missing);
  json["request_id"] = result.request_id;
  json["body_id"] = result.body_id;
  json["wanted_sigma"] = {{"rotation_deg", result.wanted.rotation_deg},
                          {"translation_mm", result.wanted.translation_mm}};
  json["eye"] = result.board ? "pattern" : "sfm";
  if (result.board) json["board"] = to_string(*result.board);
  if (result.vintage) {
    json["solved_utime"] = result.vintage->solved_utime;
    json["age_s"] = number(result.vintage->age_s);
    json["restored"] = result.vintage->restored;
  }
  add_estimate(json, result);
  json["camera"] = camera_json(result);
  json["residuals"] = residuals_json(result.residuals);
  json["residuals"]["reprojection_px"] = number(result.reprojection_px);
  add_noise(json, result);
  json["methods"] = Json::array();
  for (const MethodResult& method : result.methods) json["methods"].push_back(method_json(method));
  json["frames"] = {{"received", result.frames.received},
                    {"used", result.frames.used},
                    {"keyframes", result.frames.keyframes},
                    {"dropped", result.frames.dropped},
                    {"dark", result.frames.dark},
                    {"frozen", result.frames.frozen},
                    {"bright", result.frames.bright},
                    {"blurred", result.frames.blurred},
                    {"interlaced", result.frames.interlaced}};
  json["features"] = {{"tracked_mean", number(result.features.tracked_mean)},
                      {"points", result.features.points}};
  json["timings_ms"] = {{"tracking", number(result.timings_ms.tracking)},
                        {"reconstruction", number(result.timings_ms.reconstruction)},
                        {"handeye", number(result.timings_ms.handeye)},
                        {"total", number(result.timings_ms.total)}};
  return json;
}

}  // namespace handeye
