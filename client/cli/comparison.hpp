// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "daemon/geometry/pose.hpp"

namespace handeye::cli {

/// What a result file and a truth file have in common.
struct KnownCalibration {
  std::string verdict;                   ///< empty in a truth file
  Pose hand_from_eye{Pose::Identity()};  ///< mm
  std::optional<double> time_offset_s;
};

/// Reads hand_from_eye {q_wxyz, t_mm} and, when there, time_offset_s and verdict from a JSON file.
/// Throws InputError for a file that is missing, no JSON, or without a usable hand_from_eye.
KnownCalibration read_calibration(const std::filesystem::path& file);

/// How far an estimate is from the truth.
struct CalibrationError {
  double rotation_deg{0};                ///< angle between the two rotations
  double translation_mm{0};              ///< distance between the two translations
  std::optional<double> time_offset_ms;  ///< estimate - truth; nothing when one of them has none
};
CalibrationError calibration_error(const KnownCalibration& estimate, const KnownCalibration& truth);

}  // namespace handeye::cli
