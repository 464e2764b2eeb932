// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/result_from_json.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "protocol/exit_codes.hpp"

namespace handeye {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kUnitTolerance = 1e-6;

/// A number that says something about the answer, and may be unknown.
double figure(const Json& json, const char* key) {
  const Json& value = json.at(key);
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

std::optional<double> number_or_nothing(const Json& json, const char* key) {
  const Json& value = json.at(key);
  return value.is_null() ? std::nullopt : std::optional(value.get<double>());
}

std::string word_or_empty(const Json& json, const char* key) {
  const Json& value = json.at(key);
  return value.is_null() ? "" : value.get<std::string>();
}

Verdict verdict_from_word(const std::string& word) {
  if (word == "accepted") return Verdict::kAccepted;
  if (word == "refused") return Verdict::kRefused;
  if (word == "cancelled") return Verdict::kCancelled;
  throw InputError(fmt::format("'{}' is no verdict", word));
}

Pose pose_from_json(const Json& json) {
  const auto q = json.at("q_wxyz").get<std::array<double, 4>>();
  const auto t = json.at("t_mm").get<std::array<double, 3>>();
  const Eigen::Quaterniond rotation(q[0], q[1], q[2], q[3]);
  if (std::abs(rotation.norm() - 1) > kUnitTolerance) {
    throw InputError("q_wxyz is no unit quaternion");
  }
  return make_pose(rotation.normalized(), Eigen::Vector3d(t.data()));
}

Matrix6d covariance_from_json(const Json& json) {
  const auto rows = json.get<std::array<std::array<double, 6>, 6>>();
  Matrix6d covariance;
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      covariance(row, column) =
          rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
    }
  }
  if (!(covariance.diagonal().minCoeff() > 0)) throw InputError("the covariance is none");
  return covariance;
}

Residuals residuals_from_json(const Json& json) {
  return {figure(json, "rotation_deg"), figure(json, "rotation_percent"),
          figure(json, "translation_percent"), figure(json, "translation_norm_percent")};
}

MethodResult method_from_json(const Json& json) {
  MethodResult method;
  method.name = json.at("name").get<std::string>();
  method.time_ms = figure(json, "time_ms");
  if (!json.at("hand_from_eye").is_null()) {
    method.solution = HandEyeSolution{pose_from_json(json.at("hand_from_eye")),
                                      figure(json, "scale_units_per_mm")};
    method.residuals = residuals_from_json(json.at("residuals"));
  }
  if (json.contains("sigma")) {
    const Json& sigma = json.at("sigma");
    method.sigma = MethodSigma{figure(sigma, "rotation_deg"), figure(sigma, "translation_mm")};
  }
  return method;
}

void read_camera(const Json& json, CalibrationResult& result) {
  result.camera = {.width = json.at("width").get<int>(),
                   .height = json.at("height").get<int>(),
                   .fx = json.at("fx").get<double>(),
                   .fy = json.at("fy").get<double>(),
                   .cx = json.at("cx").get<double>(),
                   .cy = json.at("cy").get<double>(),
                   .distortion = json.at("distortion").get<std::array<double, 5>>()};
  result.camera_source = json.at("source").get<std::string>();
  if (!json.contains("sigma")) return;
  const Json& sigma = json.at("sigma");
  result.lens = LensQuality{.sigma = {.focal_px = figure(sigma, "focal_px"),
                                      .centre_px = figure(sigma, "centre_px"),
                                      .k1 = figure(sigma, "k1"),
                                      .k2 = figure(sigma, "k2"),
                                      .distortion_px = figure(sigma, "distortion_px")},
                            .observable = json.at("observable").get<bool>()};
}

/// What it was asked for, and what became of it.
void read_verdict(const Json& json, CalibrationResult& result) {
  result.verdict = verdict_from_word(json.at("verdict").get<std::string>());
  const std::string reason = word_or_empty(json, "reason");
  if (!reason.empty()) result.reason = reason_from_word(reason);
  result.advice = json.at("advice").get<std::string>();
  result.missing = word_or_empty(json, "missing");
  result.request_id = json.at("request_id").get<std::int64_t>();
  result.body_id = json.at("body_id").get<int>();
  const Json& wanted = json.at("wanted_sigma");
  result.wanted = {wanted.at("rotation_deg").get<double>(),
                   wanted.at("translation_mm").get<double>()};
  if (json.contains("board")) {
    const auto board = parse_board(json.at("board").get<std::string>());
    if (const auto* problem = std::get_if<std::string>(&board)) throw InputError(*problem);
    result.board = std::get<Board>(board);
  }
  if (json.contains("solved_utime")) {
    result.vintage = Vintage{.solved_utime = json.at("solved_utime").get<std::int64_t>(),
                             .age_s = number_or_nothing(json, "age_s"),
                             .restored = json.at("restored").get<bool>()};
  }
}

void read_estimate(const Json& json, CalibrationResult& result) {
  result.time_offset_s = number_or_nothing(json, "time_offset_s");
  result.time_offset_sigma_s = number_or_nothing(json, "time_offset_sigma_s");
  result.has_estimate = !json.at("hand_from_eye").is_null();
  if (!result.has_estimate) return;
  result.method = word_or_empty(json, "method");
  result.solution = {pose_from_json(json.at("hand_from_eye")), figure(json, "scale_units_per_mm")};
  result.covariance = covariance_from_json(json.at("covariance"));
  result.sigma_rotation_deg = json.at("sigma_rotation_deg").get<double>();
  result.sigma_translation_mm = json.at("sigma_translation_mm").get<double>();
}

void read_figures(const Json& json, CalibrationResult& result) {
  result.residuals = residuals_from_json(json.at("residuals"));
  result.reprojection_px = figure(json.at("residuals"), "reprojection_px");
  if (const Json& noise = json.at("hand_noise"); !noise.is_null()) {
    result.hand_noise = SampleNoise{noise.at("rotation_deg").get<double>(),
                                    noise.at("translation_mm").get<double>(),
                                    noise.at("source").get<std::string>()};
  }
  result.image_noise_px = number_or_nothing(json, "image_noise_px").value_or(0);
  for (const Json& method : json.at("methods")) result.methods.push_back(method_from_json(method));
  const Json& frames = json.at("frames");
  const auto count = [&](const char* key) { return frames.at(key).get<std::int64_t>(); };
  result.frames = {.received = count("received"),
                   .used = count("used"),
                   .keyframes = count("keyframes"),
                   .dropped = count("dropped"),
                   .dark = count("dark"),
                   .frozen = count("frozen"),
                   .bright = count("bright"),
                   .blurred = count("blurred"),
                   .interlaced = count("interlaced")};
  const Json& features = json.at("features");
  result.features = {figure(features, "tracked_mean"), features.at("points").get<std::int64_t>()};
  const Json& timings = json.at("timings_ms");
  result.timings_ms = {figure(timings, "tracking"), figure(timings, "reconstruction"),
                       figure(timings, "handeye"), figure(timings, "total")};
}

}  // namespace

CalibrationResult result_from_json(const Json& json) {
  try {
    CalibrationResult result;
    read_verdict(json, result);
    read_estimate(json, result);
    read_camera(json.at("camera"), result);
    read_figures(json, result);
    return result;
  } catch (const Json::exception& error) {
    throw InputError(error.what());
  }
}

}  // namespace handeye
