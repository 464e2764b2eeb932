// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "daemon/geometry/pose.hpp"

namespace handeye {

/// Hand and eye at one instant, as a row of a pose file says.
struct PoseRow {
  Pose room_from_hand{Pose::Identity()};  ///< mm
  Pose eye_from_scene{Pose::Identity()};  ///< mm, or units of the scene's own
};

/// First line of a pose file: the names of its columns, in this order.
inline constexpr std::string_view kPoseFileHeader =
    "hand_qw,hand_qx,hand_qy,hand_qz,hand_x,hand_y,hand_z,"
    "eye_qw,eye_qx,eye_qy,eye_qz,eye_x,eye_y,eye_z";

/// Reads a CSV of poses: the header above, then a row for each instant. Quaternions must have norm
/// 1 within 0.001 and are normalised. Spaces round a field, "\r\n" and empty lines at the end are
/// accepted; a file without rows is an empty list. Throws InputError that names file, line, column
/// and what to do.
std::vector<PoseRow> read_pose_file(const std::filesystem::path& path);

}  // namespace handeye
