// SPDX-License-Identifier: BSD-3-Clause
#include "client/cli/result_parts.hpp"

#include <cmath>

#include <fmt/format.h>

namespace handeye::cli {
namespace {

std::string against_wanted(double sigma, double wanted, std::string_view unit,
                           const Palette& palette) {
  const std::string value = fmt::format("{:.3f} {}", sigma, unit);
  return fmt::format("{} (wanted {:.3g})", sigma <= wanted ? value : palette.red(value), wanted);
}

}  // namespace

std::string row(std::string_view label, std::string_view value) {
  return fmt::format("  {:<15}{}\n", label, value);
}

std::string verdict_text(const CalibrationResult& result, std::string_view rests_on,
                         const Palette& palette) {
  const std::string about = palette.dim("  " + std::string(rests_on));
  const std::string advice = result.advice.empty() ? "" : "  " + printable(result.advice) + "\n";
  if (result.verdict == Verdict::kAccepted) {
    return palette.green("ACCEPTED") + about + "\n" + advice;
  }
  const bool cancelled = result.verdict == Verdict::kCancelled;
  std::string text = palette.red(cancelled ? "CANCELLED" : "REFUSED");
  if (!cancelled) text += ": " + palette.bold(reason_word(result.reason));
  text += about + "\n" + advice;
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

std::string uncertainty_text(const CalibrationResult& result, const Palette& palette) {
  return row(
      "uncertainty",
      "rotation " +
          against_wanted(result.sigma_rotation_deg, result.wanted.rotation_deg, "deg", palette) +
          ", translation " +
          against_wanted(result.sigma_translation_mm, result.wanted.translation_mm, "mm", palette));
}

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

}  // namespace handeye::cli
