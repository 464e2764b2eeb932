// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/geometry/pose.hpp"
#include "drivers/dtrack/scanner.hpp"

/// The blocks that several line types share.
namespace handeye::dtrack {

/// `[x y z]`, mm.
bool read_position(Scanner& line, Eigen::Vector3d& position_mm);

/// `[x y z eta theta phi]`: the vendor advises against the angles, so they are only checked to be
/// numbers; the matrix behind them counts.
bool read_position_and_angles(Scanner& line, Eigen::Vector3d& position_mm);

/// `[b0 .. b8]`, column by column; any nine numbers.
bool read_matrix(Scanner& line, Eigen::Matrix3d& matrix);

/// Builds a pose from what was printed, removing the round-off of the matrix. False, and nothing
/// written, if the matrix is no rotation: |R'R - I| beyond kRotationTolerance, or a reflection.
bool make_pose_of_printed(const Eigen::Matrix3d& matrix, const Eigen::Vector3d& position_mm,
                          Pose& pose);

}  // namespace handeye::dtrack
