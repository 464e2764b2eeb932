// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/geometry/pose.hpp"
#include "daemon/pattern/board_detector.hpp"

namespace handeye {

struct BoardPoseOptions {
  /// Beyond this rms the corners are not the board's, or the lens is another [px]. A lens that is
  /// off by what a careless calibration leaves makes about one.
  double max_reprojection_px{3.0};
  /// A plane seen from afar has two poses that fit. The second must be worse by this much in the
  /// sum of squares, in units of the corners' variance: three standard deviations.
  double min_mirror_chi2{9.0};
};

struct BoardPose {
  Pose eye_from_board{Pose::Identity()};  ///< mm; the board's frame as in Board::corners_mm
  double reprojection_px{0};              ///< rms
};

/// Where the board is, from its corners: both planar solutions (Collins, Bartoli: Infinitesimal
/// plane-based pose estimation, 2014), each refined by Levenberg-Marquardt on the reprojection
/// error; the better one. Nothing for fewer than four corners, corners on one line, a pose behind
/// the camera, two poses that cannot be told apart, or a bad fit.
std::optional<BoardPose> board_pose(const std::vector<Eigen::Vector3d>& corners_mm,
                                    const std::vector<BoardCorner>& corners,
                                    const CameraModel& camera,
                                    const BoardPoseOptions& options = {});

}  // namespace handeye
