// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/pattern/board_detector.hpp"

namespace handeye {

/// The camera model as OpenCV's functions take it.
inline cv::Matx33d camera_matrix(const CameraModel& camera) {
  return {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
}
inline cv::Mat distortion_coefficients(const CameraModel& camera) {
  return cv::Mat(camera.distortion, true);
}

/// Corners of one image and where they are on the board [mm], side by side.
struct CornerPairs {
  std::vector<cv::Point3f> board_mm;
  std::vector<cv::Point2f> pixels;
};
inline CornerPairs pair_corners(const std::vector<Eigen::Vector3d>& corners_mm,
                                const std::vector<BoardCorner>& corners) {
  CornerPairs pairs;
  for (const BoardCorner& corner : corners) {
    const Eigen::Vector3f mm = corners_mm[static_cast<std::size_t>(corner.id)].cast<float>();
    const Eigen::Vector2f px = corner.pixel.cast<float>();
    pairs.board_mm.emplace_back(mm.x(), mm.y(), mm.z());
    pairs.pixels.emplace_back(px.x(), px.y());
  }
  return pairs;
}

}  // namespace handeye
