// SPDX-License-Identifier: BSD-3-Clause
#include "client/cli/result_text.hpp"

#include <fmt/format.h>

#include "client/cli/result_parts.hpp"
#include "daemon/session/age_text.hpp"

namespace handeye::cli {
namespace {

std::string time_offset_text(const CalibrationResult& result) {
  if (!result.time_offset_s) return row("time offset", "not estimated");
  std::string text = fmt::format("{:+.2f} ms", *result.time_offset_s * 1e3);
  if (result.time_offset_sigma_s) {
    text += fmt::format(" +- {:.2f} ms", *result.time_offset_sigma_s * 1e3);
  }
  return row("time offset", text + ", added to the tracker's time stamps");
}

/// Only of an old answer: that a new one is new goes without saying.
std::string vintage_text(const CalibrationResult& result) {
  constexpr double kNew_s = 60;
  if (!result.vintage) return "";
  const Vintage& vintage = *result.vintage;
  if (!vintage.restored && vintage.age_s && *vintage.age_s < kNew_s) return "";
  return row("age", age_text(vintage.age_s) +
                        (vintage.restored ? ", from before the daemon's restart" : ""));
}

/// What is found of a lens with the calibration, and how sure that is.
std::string lens_text(const CalibrationResult& result) {
  if (!result.lens) return "";
  if (!result.lens->observable) {
    return row("lens", "not found: the images do not tell it, or the hand's turns contradict it");
  }
  const CameraModel& camera = result.camera;
  const LensSigma& sigma = result.lens->sigma;
  return row("lens", fmt::format("focal length {:.2f} +- {:.2f} px, centre +- {:.2f} px, k1 {:.4f} "
                                 "+- {:.4f}, k2 {:.4f} +- {:.4f}; distortion +- {:.2f} px",
                                 0.5 * (camera.fx + camera.fy), sigma.focal_px, sigma.centre_px,
                                 camera.distortion[0], sigma.k1, camera.distortion[1], sigma.k2,
                                 sigma.distortion_px));
}

std::string camera_text(const CalibrationResult& result) {
  const CameraModel& camera = result.camera;
  return row("camera", fmt::format("{}x{}  fx {:.2f}  fy {:.2f}  cx {:.2f}  cy {:.2f} px, {}",
                                   camera.width, camera.height, camera.fx, camera.fy, camera.cx,
                                   camera.cy, printable(result.camera_source))) +
         lens_text(result);
}

/// Whose answer it is, and by what it weighed what was seen.
std::string answer_text(const CalibrationResult& result) {
  std::string text = row("answer", printable(result.method));
  if (result.hand_noise) {
    std::string noise =
        fmt::format("tracker {:.3f} deg, {:.3f} mm ({})", result.hand_noise->rotation_deg,
                    result.hand_noise->translation_mm, printable(result.hand_noise->source));
    if (result.image_noise_px > 0) {
      noise += fmt::format("; images {:.3f} px", result.image_noise_px);
    }
    text += row("noise", noise);
  }
  return text;
}

/// A method's own sigma, in as many characters.
std::string sigma_text(const MethodResult& method) {
  if (!method.sigma) return fmt::format("{:>12}{:>12}", "", "");
  return fmt::format("{:>12.4f}{:>12.3f}", method.sigma->rotation_deg,
                     method.sigma->translation_mm);
}

/// The columns of the paper's tables, and what each says of its own uncertainty.
std::string methods_text(const CalibrationResult& result, const Palette& palette) {
  if (result.methods.empty()) return "";
  std::string text = "\n  " +
                     palette.bold(fmt::format("{:<28}{:>14}{:>14}{:>12}{:>12}{:>12}{:>10}",
                                              "method", "translation %", "rotation deg",
                                              "rotation %", "sigma deg", "sigma mm", "time ms")) +
                     "\n";
  for (const MethodResult& method : result.methods) {
    const std::string name = printable(method.name);
    if (!method.solution) {
      text += fmt::format("  {:<28}{:>14}\n", name, "no solution");
      continue;
    }
    const Residuals& residuals = method.residuals;
    text += fmt::format("  {:<28}{:>14.3f}{:>14.4f}{:>12.3f}{}{:>10.2f}\n", name,
                        residuals.translation_percent, residuals.rotation_deg,
                        residuals.rotation_percent, sigma_text(method), method.time_ms);
  }
  return text + "\n";
}

std::string features_text(const CalibrationResult& result) {
  if (result.board) {
    return row("board",
               fmt::format("{}: {:.0f} of {} corners seen on average", to_string(*result.board),
                           result.features.tracked_mean, result.board->corners_mm().size()));
  }
  return row("features", fmt::format("{:.0f} tracked on average, {} points reconstructed",
                                     result.features.tracked_mean, result.features.points));
}

std::string basis_text(const CalibrationResult& result) {
  const auto& frames = result.frames;
  const auto& timings = result.timings_ms;
  return row("frames",
             fmt::format("{} received, {} used, {} keyframes, {} dropped", frames.received,
                         frames.used, frames.keyframes, frames.dropped)) +
         features_text(result) +
         row("time spent",
             fmt::format("tracking {:.0f} ms, reconstruction {:.0f} ms, hand-eye {:.0f} ms, "
                         "total {:.0f} ms",
                         timings.tracking, timings.reconstruction, timings.handeye, timings.total));
}

}  // namespace

std::string result_text(const CalibrationResult& result, const Palette& palette) {
  std::string text = verdict_text(result, fmt::format("body {}", result.body_id), palette);
  text += vintage_text(result);
  if (result.has_estimate) {
    text += pose_text(result.solution.hand_from_eye);
    text += uncertainty_text(result, palette);
    text += time_offset_text(result);
    text += row("residual", fmt::format("{:.3f} px reprojection, {:.4f} deg, {:.3f} % translation",
                                        result.reprojection_px, result.residuals.rotation_deg,
                                        result.residuals.translation_percent));
    text += answer_text(result);
    text += camera_text(result);
    text += methods_text(result, palette);
  }
  return text + basis_text(result);
}

}  // namespace handeye::cli
