// SPDX-License-Identifier: BSD-3-Clause
#include "client/cli/result_text.hpp"

#include <cmath>

#include <fmt/format.h>

namespace handeye::cli {
namespace {

std::string row(std::string_view label, std::string_view value) {
  return fmt::format("  {:<15}{}\n", label, value);
}

std::string verdict_text(const CalibrationResult& result, const Palette& palette) {
  const std::string about = palette.dim(fmt::format("  body {}", result.body_id));
  if (result.verdict == Verdict::kAccepted) return palette.green("ACCEPTED") + about + "\n";
  const bool cancelled = result.verdict == Verdict::kCancelled;
  std::string text = palette.red(cancelled ? "CANCELLED" : "REFUSED");
  if (!cancelled) text += ": " + palette.bold(reason_word(result.reason));
  text += about + "\n";
  if (!result.advice.empty()) text += "  " + printable(result.advice) + "\n";
  if (result.has_estimate) {
    text += "  " + palette.red("The estimate below must not be used.") + "\n";
  }
  return text;
}

std::string pose_text(const Pose& hand_from_eye) {
  Eigen::Quaterniond q(hand_from_eye.linear());
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const EulerAngles euler = euler_angles(hand_from_eye.linear());
  const Eigen::Vector3d& t_mm = hand_from_eye.translation();
  return "  hand_from_eye\n" +
         row("  quaternion",
             fmt::format("w {:.6f}  x {:.6f}  y {:.6f}  z {:.6f}", q.w(), q.x(), q.y(), q.z())) +
         row("  Euler", fmt::format("roll {:.3f}  pitch {:.3f}  yaw {:.3f} deg  (Rz Ry Rx)",
                                    euler.roll_deg, euler.pitch_deg, euler.yaw_deg)) +
         row("  translation",
             fmt::format("x {:.3f}  y {:.3f}  z {:.3f} mm", t_mm.x(), t_mm.y(), t_mm.z()));
}

std::string against_wanted(double sigma, double wanted, std::string_view unit,
                           const Palette& palette) {
  const std::string value = fmt::format("{:.3f} {}", sigma, unit);
  return fmt::format("{} (wanted {:.3g})", sigma <= wanted ? value : palette.red(value), wanted);
}

std::string uncertainty_text(const CalibrationResult& result, const Palette& palette) {
  return row(
      "uncertainty",
      "rotation " +
          against_wanted(result.sigma_rotation_deg, result.wanted.rotation_deg, "deg", palette) +
          ", translation " +
          against_wanted(result.sigma_translation_mm, result.wanted.translation_mm, "mm", palette));
}

std::string time_offset_text(const CalibrationResult& result) {
  if (!result.time_offset_s) return row("time offset", "not estimated");
  std::string text = fmt::format("{:+.2f} ms", *result.time_offset_s * 1e3);
  if (result.time_offset_sigma_s) {
    text += fmt::format(" +- {:.2f} ms", *result.time_offset_sigma_s * 1e3);
  }
  return row("time offset", text + ", added to the tracker's time stamps");
}

std::string camera_text(const CalibrationResult& result) {
  const CameraModel& camera = result.camera;
  return row("camera", fmt::format("{}x{}  fx {:.2f}  fy {:.2f}  cx {:.2f}  cy {:.2f} px, {}",
                                   camera.width, camera.height, camera.fx, camera.fy, camera.cx,
                                   camera.cy, printable(result.camera_source)));
}

/// The columns of the paper's tables.
std::string methods_text(const CalibrationResult& result, const Palette& palette) {
  if (result.methods.empty()) return "";
  std::string text =
      "\n  " +
      palette.bold(fmt::format("{:<28}{:>14}{:>14}{:>12}{:>10}", "method", "translation %",
                               "rotation deg", "rotation %", "time ms")) +
      "\n";
  for (const MethodResult& method : result.methods) {
    const std::string name = printable(method.name);
    if (!method.solution) {
      text += fmt::format("  {:<28}{:>14}\n", name, "no solution");
      continue;
    }
    const Residuals& residuals = method.residuals;
    text += fmt::format("  {:<28}{:>14.3f}{:>14.4f}{:>12.3f}{:>10.2f}\n", name,
                        residuals.translation_percent, residuals.rotation_deg,
                        residuals.rotation_percent, method.time_ms);
  }
  return text + "\n";
}

std::string basis_text(const CalibrationResult& result) {
  const auto& frames = result.frames;
  const auto& timings = result.timings_ms;
  return row("frames",
             fmt::format("{} received, {} used, {} keyframes, {} dropped", frames.received,
                         frames.used, frames.keyframes, frames.dropped)) +
         row("features", fmt::format("{:.0f} tracked on average, {} points reconstructed",
                                     result.features.tracked_mean, result.features.points)) +
         row("time spent",
             fmt::format("tracking {:.0f} ms, reconstruction {:.0f} ms, hand-eye {:.0f} ms, "
                         "total {:.0f} ms",
                         timings.tracking, timings.reconstruction, timings.handeye, timings.total));
}

}  // namespace

EulerAngles euler_angles(const Eigen::Matrix3d& rotation) {
  const double cos_pitch = std::hypot(rotation(0, 0), rotation(1, 0));
  const double pitch = std::atan2(0.0 - rotation(2, 0), cos_pitch);  // 0 - 0: no negative zero
  constexpr double kGimbalLock = 1e-9;
  if (cos_pitch < kGimbalLock) {
    const double yaw = std::atan2(-rotation(0, 1), rotation(1, 1));
    return {0.0, deg_from_rad(pitch), deg_from_rad(yaw)};
  }
  return {deg_from_rad(std::atan2(rotation(2, 1), rotation(2, 2))), deg_from_rad(pitch),
          deg_from_rad(std::atan2(rotation(1, 0), rotation(0, 0)))};
}

std::string result_text(const CalibrationResult& result, const Palette& palette) {
  std::string text = verdict_text(result, palette);
  if (result.has_estimate) {
    text += pose_text(result.solution.hand_from_eye);
    text += uncertainty_text(result, palette);
    text += time_offset_text(result);
    text += row("residual", fmt::format("{:.3f} px reprojection, {:.4f} deg, {:.3f} % translation",
                                        result.reprojection_px, result.residuals.rotation_deg,
                                        result.residuals.translation_percent));
    text += camera_text(result);
    text += methods_text(result, palette);
  }
  return text + basis_text(result);
}

}  // namespace handeye::cli
