// SPDX-License-Identifier: BSD-3-Clause
#include "client/cli/solve_text.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "client/cli/result_parts.hpp"

namespace handeye::cli {
namespace {

std::string basis(const PoseSolution& solution) {
  std::string text = fmt::format("{} pose{}", solution.poses, solution.poses == 1 ? "" : "s");
  if (solution.poses_used > 0 && solution.poses_used < solution.poses) {
    text += fmt::format(", {} used", solution.poses_used);
  }
  return text + (solution.scale == ScaleMode::kKnown ? ", scale known" : ", scale unknown");
}

/// "rows 7, 12, 30": counted from 1, as people count rows.
std::string rows_of(const std::vector<std::size_t>& poses) {
  std::string rows = poses.size() == 1 ? "row" : "rows";
  for (const std::size_t pose : poses) {
    rows += fmt::format("{} {}", pose == poses.front() ? "" : ",", pose + 1);
  }
  return rows;
}

std::string left_out_text(const PoseSolution& solution, const Palette& palette) {
  const std::vector<std::size_t>& wrong = solution.wrong_poses;
  const std::vector<std::size_t>& rejected = solution.rejected_poses;
  std::string text;
  if (!wrong.empty()) {
    const std::string what = wrong.size() == 1 ? "disagrees with the others and was left out"
                                               : "disagree with the others and were left out";
    text += "  " +
            palette.yellow(fmt::format("{} of {} poses {}: {}", wrong.size(), solution.poses, what,
                                       rows_of(wrong))) +
            "\n";
  }
  if (!rejected.empty()) {
    text += "  " +
            palette.yellow("left out by maximum_likelihood, beyond what the noise explains: " +
                           rows_of(rejected)) +
            "\n";
  }
  return text;
}

/// Noise that the residuals show nothing of is estimated as next to nothing.
std::string small_figure(double value) {
  return value < 0.001 ? std::string("<0.001") : fmt::format("{:.3g}", value);
}

std::string device_text(double rotation_rad, double translation_mm) {
  return small_figure(deg_from_rad(rotation_rad)) + " deg " + small_figure(translation_mm) + " mm";
}

std::string noise_text(const PoseSolution& solution) {
  const PoseNoise& noise = solution.noise;
  const std::string exceeded =
      solution.noise_factor > 1.0
          ? row("", fmt::format("the residuals show {:.3g} times as much; every sigma is widened",
                                solution.noise_factor))
          : std::string();
  return row("noise per axis",
             fmt::format("hand {}, eye {}, {}",
                         device_text(noise.hand_rotation_rad, noise.hand_translation_mm),
                         device_text(noise.eye_rotation_rad, noise.eye_translation_mm),
                         solution.noise_estimated ? "estimated" : "given")) +
         exceeded;
}

std::string estimate_text(const PoseSolution& solution, const Palette& palette) {
  const CalibrationResult& result = solution.calibration;
  std::string text = pose_text(result.solution.hand_from_eye);
  if (solution.scale == ScaleMode::kUnknown) {
    text += row("scale", fmt::format("{:.6g} units per mm", result.solution.scale_units_per_mm));
  }
  return text + uncertainty_text(result, palette) + noise_text(solution);
}

/// The columns of the paper's tables, and how far each method's answer can be trusted.
std::string residual_table(const CalibrationResult& result, const Palette& palette) {
  std::string text = "\n  " +
                     palette.bold(fmt::format("{:<27}{:>13}{:>13}{:>12}{:>10}{:>11}{:>10}",
                                              "method", "translation %", "rotation deg",
                                              "rotation %", "time ms", "sigma deg", "sigma mm")) +
                     "\n";
  for (const MethodResult& method : result.methods) {
    if (!method.solution) {
      text += fmt::format("  {:<27}{:>13}\n", method.name, "no solution");
      continue;
    }
    const Residuals& residuals = method.residuals;
    text += fmt::format("  {:<27}{:>13.4g}{:>13.4g}{:>12.4g}{:>10.2f}", method.name,
                        residuals.translation_percent, residuals.rotation_deg,
                        residuals.rotation_percent, method.time_ms);
    if (method.sigma) {
      text += fmt::format("{:>11.4g}{:>10.4g}", method.sigma->rotation_deg,
                          method.sigma->translation_mm);
    }
    text += "\n";
  }
  return text;
}

std::string pose_table(const CalibrationResult& result, const Palette& palette) {
  const auto solved = [](const MethodResult& method) { return method.solution.has_value(); };
  if (std::ranges::none_of(result.methods, solved)) return {};
  std::string text = "\n  " +
                     palette.bold(fmt::format("{:<27}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>14}",
                                              "hand_from_eye", "x mm", "y mm", "z mm", "roll deg",
                                              "pitch", "yaw", "units per mm")) +
                     "\n";
  for (const MethodResult& method : result.methods) {
    if (!method.solution) continue;
    const Pose& pose = method.solution->hand_from_eye;
    const Eigen::Vector3d& t_mm = pose.translation();
    const EulerAngles euler = euler_angles(pose.linear());
    text += fmt::format("  {:<27}{:>10.3f}{:>10.3f}{:>10.3f}{:>10.3f}{:>10.3f}{:>10.3f}{:>14.6g}\n",
                        method.name, t_mm.x(), t_mm.y(), t_mm.z(), euler.roll_deg, euler.pitch_deg,
                        euler.yaw_deg, method.solution->scale_units_per_mm);
  }
  return text;
}

}  // namespace

std::string solve_text(const PoseSolution& solution, const Palette& palette) {
  const CalibrationResult& result = solution.calibration;
  std::string text = verdict_text(result, basis(solution), palette);
  text += left_out_text(solution, palette);
  if (result.has_estimate) text += estimate_text(solution, palette);
  return text + residual_table(result, palette) + pose_table(result, palette);
}

}  // namespace handeye::cli
