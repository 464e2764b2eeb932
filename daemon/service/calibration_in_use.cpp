// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/calibration_in_use.hpp"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

namespace handeye {
namespace {

constexpr double kLeastImageNoise_px = 0.4;

SampleNoise hand_noise(const CalibrationResult& result, const Config::Tracker& tracker) {
  return result.hand_noise.value_or(
      SampleNoise{tracker.noise_rotation_deg, tracker.noise_translation_mm, "given"});
}

}  // namespace

std::optional<std::int64_t> solved_ns(const Vintage& vintage, std::int64_t now_ns) {
  if (!vintage.age_s) return std::nullopt;
  return now_ns - static_cast<std::int64_t>(1e9 * *vintage.age_s);
}

ActiveCalibration active_calibration(const CalibrationResult& result,
                                     const Config::Tracker& tracker, std::int64_t now_ns) {
  const SampleNoise noise = hand_noise(result, tracker);
  const Vintage vintage = result.vintage.value_or(Vintage{});
  return {.request_id = result.request_id,
          .accepted_ns = solved_ns(vintage, now_ns),
          .restored = vintage.restored,
          .body_id = result.body_id,
          .hand_from_eye = result.solution.hand_from_eye,
          .covariance = result.covariance,
          .time_offset_ns = static_cast<std::int64_t>(1e9 * result.time_offset_s.value_or(0)),
          .time_offset_sigma_s = result.time_offset_sigma_s.value_or(0),
          .hand_noise = {.rotation_rad = rad_from_deg(noise.rotation_deg),
                         .translation_mm = noise.translation_mm}};
}

std::optional<std::string> misfit(const CalibrationResult& result, const CameraModel& camera) {
  const CameraModel& its = result.camera;
  if (its.width != camera.width || its.height != camera.height) {
    return fmt::format("it is of a {}x{} camera, and the configured one is {}x{}", its.width,
                       its.height, camera.width, camera.height);
  }
  // A lens that was found, or refined, differs from the configured one in any case.
  if (result.lens) return std::nullopt;
  const auto lens = [](const CameraModel& model) {
    return std::tuple(model.fx, model.fy, model.cx, model.cy, model.distortion);
  };
  if (lens(its) == lens(camera)) return std::nullopt;
  return "the camera's intrinsics have been changed since";
}

WatchedCalibration watched_calibration(const CalibrationResult& result,
                                       const Config::Tracker& tracker) {
  const SampleNoise noise = hand_noise(result, tracker);
  return {.hand_from_eye = result.solution.hand_from_eye,
          .covariance = result.covariance,
          .time_offset_s = result.time_offset_s.value_or(0),
          .camera = result.camera,
          .hand_noise = {rad_from_deg(std::max(noise.rotation_deg, tracker.noise_rotation_deg)),
                         std::max(noise.translation_mm, tracker.noise_translation_mm)},
          .image_noise_px = std::max(kLeastImageNoise_px, result.image_noise_px)};
}

}  // namespace handeye
