// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/result_message.hpp"

#include <algorithm>

#include "daemon/session/method_message.hpp"
#include "daemon/session/pose_message.hpp"

namespace handeye {
namespace {

// What result_t says where there is nothing to say.
constexpr double kNoTimeOffset = 0;
constexpr double kNoTimeOffsetSigma = -1;
constexpr double kNoAge = -1;
// The source of a lens of which no more is said.
constexpr std::string_view kGivenLens = "given";

std::int32_t verdict_code(Verdict verdict) {
  switch (verdict) {
    case Verdict::kAccepted:
      return result_t::ACCEPTED;
    case Verdict::kRefused:
      return result_t::REFUSED;
    case Verdict::kCancelled:
      return result_t::CANCELLED;
  }
  return result_t::REFUSED;
}

Verdict verdict_from_code(std::int32_t code) {
  if (code == result_t::ACCEPTED) return Verdict::kAccepted;
  if (code == result_t::CANCELLED) return Verdict::kCancelled;
  return Verdict::kRefused;
}

void write_camera(const CalibrationResult& result, result_t& message) {
  message.width = result.camera.width;
  message.height = result.camera.height;
  message.fx = result.camera.fx;
  message.fy = result.camera.fy;
  message.cx = result.camera.cx;
  message.cy = result.camera.cy;
  std::ranges::copy(result.camera.distortion, message.distortion);
  message.camera_source = result.camera_source;
  const LensQuality lens = result.lens.value_or(LensQuality{.observable = true});
  message.lens_observable = lens.observable;
  message.lens_sigma_focal_px = lens.sigma.focal_px;
  message.lens_sigma_centre_px = lens.sigma.centre_px;
  message.lens_sigma_k1 = lens.sigma.k1;
  message.lens_sigma_k2 = lens.sigma.k2;
  message.lens_sigma_distortion_px = lens.sigma.distortion_px;
}

void read_camera(const result_t& message, CalibrationResult& result) {
  result.camera.width = message.width;
  result.camera.height = message.height;
  result.camera.fx = message.fx;
  result.camera.fy = message.fy;
  result.camera.cx = message.cx;
  result.camera.cy = message.cy;
  std::ranges::copy(message.distortion, result.camera.distortion.begin());
  result.camera_source = message.camera_source;
  if (message.camera_source == kGivenLens) return;
  result.lens = LensQuality{.sigma = {.focal_px = message.lens_sigma_focal_px,
                                      .centre_px = message.lens_sigma_centre_px,
                                      .k1 = message.lens_sigma_k1,
                                      .k2 = message.lens_sigma_k2,
                                      .distortion_px = message.lens_sigma_distortion_px},
                            .observable = message.lens_observable != 0};
}

void write_noise(const CalibrationResult& result, result_t& message) {
  message.image_noise_px = result.image_noise_px;
  if (!result.hand_noise) return;
  message.hand_noise_rotation_deg = result.hand_noise->rotation_deg;
  message.hand_noise_translation_mm = result.hand_noise->translation_mm;
  message.hand_noise_source = result.hand_noise->source;
}

void read_noise(const result_t& message, CalibrationResult& result) {
  result.image_noise_px = message.image_noise_px;
  if (message.hand_noise_source.empty()) return;
  result.hand_noise = SampleNoise{message.hand_noise_rotation_deg,
                                  message.hand_noise_translation_mm, message.hand_noise_source};
}

void write_figures(const CalibrationResult& result, result_t& message) {
  message.residual_rotation_deg = result.residuals.rotation_deg;
  message.residual_rotation_percent = result.residuals.rotation_percent;
  message.residual_translation_percent = result.residuals.translation_percent;
  message.residual_translation_norm_percent = result.residuals.translation_norm_percent;
  message.reprojection_px = result.reprojection_px;
  message.frames_received = result.frames.received;
  message.frames_used = result.frames.used;
  message.frames_keyframes = result.frames.keyframes;
  message.frames_dropped = result.frames.dropped;
  message.frames_dark = result.frames.dark;
  message.frames_frozen = result.frames.frozen;
  message.frames_bright = result.frames.bright;
  message.frames_blurred = result.frames.blurred;
  message.frames_interlaced = result.frames.interlaced;
  message.features_tracked_mean = result.features.tracked_mean;
  message.points = result.features.points;
  message.time_tracking_ms = result.timings_ms.tracking;
  message.time_reconstruction_ms = result.timings_ms.reconstruction;
  message.time_handeye_ms = result.timings_ms.handeye;
  message.time_total_ms = result.timings_ms.total;
}

void read_figures(const result_t& message, CalibrationResult& result) {
  result.residuals = {message.residual_rotation_deg, message.residual_rotation_percent,
                      message.residual_translation_percent,
                      message.residual_translation_norm_percent};
  result.reprojection_px = message.reprojection_px;
  result.frames = {.received = message.frames_received,
                   .used = message.frames_used,
                   .keyframes = message.frames_keyframes,
                   .dropped = message.frames_dropped,
                   .dark = message.frames_dark,
                   .frozen = message.frames_frozen,
                   .bright = message.frames_bright,
                   .blurred = message.frames_blurred,
                   .interlaced = message.frames_interlaced};
  result.features = {message.features_tracked_mean, message.points};
  result.timings_ms = {message.time_tracking_ms, message.time_reconstruction_ms,
                       message.time_handeye_ms, message.time_total_ms};
}

void write_vintage(const Vintage& vintage, result_t& message) {
  message.solved_utime = vintage.solved_utime;
  message.age_s = vintage.age_s.value_or(kNoAge);
  message.restored = vintage.restored;
}

Vintage vintage_from_message(const result_t& message) {
  Vintage vintage{.solved_utime = message.solved_utime,
                  .age_s = std::nullopt,
                  .restored = message.restored != 0};
  if (message.age_s >= 0) vintage.age_s = message.age_s;
  return vintage;
}

/// A daemon sends nothing else but boards.
std::optional<Board> board_from_message(const std::string& text) {
  const auto parsed = parse_board(text);
  if (const auto* board = std::get_if<Board>(&parsed)) return *board;
  return std::nullopt;
}

}  // namespace

result_t to_message(const CalibrationResult& result) {
  result_t message{};
  message.request_id = result.request_id;
  message.verdict = verdict_code(result.verdict);
  message.reason = reason_word(result.reason);
  message.advice = result.advice;
  message.missing = result.missing;
  message.method = result.method;
  message.has_estimate = result.has_estimate;
  message.body_id = result.body_id;
  if (result.has_estimate) {
    write_pose(result.solution.hand_from_eye, message.q_wxyz, message.t_mm);
    Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>> covariance(message.covariance);
    covariance = result.covariance;
    message.sigma_rotation_deg = result.sigma_rotation_deg;
    message.sigma_translation_mm = result.sigma_translation_mm;
    message.scale_units_per_mm = result.solution.scale_units_per_mm;
  }
  message.wanted_sigma_rotation_deg = result.wanted.rotation_deg;
  message.wanted_sigma_translation_mm = result.wanted.translation_mm;
  message.time_offset_s = result.time_offset_s.value_or(kNoTimeOffset);
  message.time_offset_sigma_s = result.time_offset_s
                                    ? result.time_offset_sigma_s.value_or(kNoTimeOffsetSigma)
                                    : kNoTimeOffsetSigma;
  if (result.vintage) write_vintage(*result.vintage, message);
  write_camera(result, message);
  write_noise(result, message);
  write_figures(result, message);
  for (const MethodResult& method : result.methods) {
    message.methods.push_back(method_message(method));
  }
  if (result.board) message.board = to_string(*result.board);
  message.num_methods = static_cast<std::int32_t>(message.methods.size());
  return message;
}

CalibrationResult from_message(const result_t& message) {
  CalibrationResult result;
  result.request_id = message.request_id;
  result.body_id = message.body_id;
  result.verdict = verdict_from_code(message.verdict);
  result.reason = reason_from_word(message.reason);
  result.advice = message.advice;
  result.missing = message.missing;
  result.method = message.method;
  result.wanted = {message.wanted_sigma_rotation_deg, message.wanted_sigma_translation_mm};
  result.has_estimate = message.has_estimate != 0;
  if (result.has_estimate) {
    result.solution = {read_pose(message.q_wxyz, message.t_mm), message.scale_units_per_mm};
    result.covariance =
        Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(message.covariance);
    result.sigma_rotation_deg = message.sigma_rotation_deg;
    result.sigma_translation_mm = message.sigma_translation_mm;
  }
  if (message.time_offset_sigma_s >= 0) {
    result.time_offset_s = message.time_offset_s;
    result.time_offset_sigma_s = message.time_offset_sigma_s;
  }
  if (message.solved_utime != 0) result.vintage = vintage_from_message(message);
  read_camera(message, result);
  read_noise(message, result);
  read_figures(message, result);
  result.board = board_from_message(message.board);
  for (const method_result_t& method : message.methods) {
    result.methods.push_back(method_from_message(method));
  }
  return result;
}

}  // namespace handeye
