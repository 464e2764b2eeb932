// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "client/cli/terminal.hpp"
#include "daemon/session/result.hpp"

/// What results have in common wherever they are printed. Each text ends with its newline.
namespace handeye::cli {

/// "  label          value".
std::string row(std::string_view label, std::string_view value);

/// ACCEPTED, or REFUSED with reason and advice, and a warning where there is an estimate.
/// `rests_on`: a word on what the result is of.
std::string verdict_text(const CalibrationResult& result, std::string_view rests_on,
                         const Palette& palette);

/// Quaternion, Euler angles and translation.
std::string pose_text(const Pose& hand_from_eye);

/// The two sigmas against what was wanted.
std::string uncertainty_text(const CalibrationResult& result, const Palette& palette);

/// Euler angles of R = Rz(yaw) Ry(pitch) Rx(roll) [deg]; roll 0 where pitch is +-90 deg.
struct EulerAngles {
  double roll_deg{0};
  double pitch_deg{0};
  double yaw_deg{0};
};
EulerAngles euler_angles(const Eigen::Matrix3d& rotation);

}  // namespace handeye::cli
