// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/session/trial.hpp"

#include <fmt/format.h>

namespace handeye::trial {
namespace {

constexpr double kHonest = 3.5;  // error in its own standard deviations

std::string verdict_of(const Trial& trial) {
  const CalibrationResult& result = trial.result;
  if (trial.accepted()) return "accepted";
  return fmt::format("refused, {} ({}),", reason_word(result.reason), result.missing);
}

}  // namespace

double Trial::error_in_sigmas() const {
  return std::max(rotation_error_deg / result.sigma_rotation_deg,
                  translation_error_mm / result.sigma_translation_mm);
}

bool Trial::is_honest() const {
  return error_in_sigmas() < kHonest;
}

Trial against(const Pose& true_hand_from_eye, CalibrationResult result) {
  Trial trial{.result = std::move(result)};
  if (!trial.result.has_estimate) return trial;
  const Pose& found = trial.result.solution.hand_from_eye;
  trial.rotation_error_deg =
      deg_from_rad(rotation_angle_rad(found.linear(), true_hand_from_eye.linear()));
  trial.translation_error_mm = (found.translation() - true_hand_from_eye.translation()).norm();
  return trial;
}

std::string describe(const Trial& trial) {
  const CalibrationResult& result = trial.result;
  if (!result.has_estimate) return verdict_of(trial) + " no estimate";
  return fmt::format("{} {} {:.3f} deg (sigma {:.3f}), {:.2f} mm (sigma {:.2f}), {} of {} frames",
                     verdict_of(trial), result.method, trial.rotation_error_deg,
                     result.sigma_rotation_deg, trial.translation_error_mm,
                     result.sigma_translation_mm, result.frames.used, result.frames.received);
}

}  // namespace handeye::trial
