// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/board_eye.hpp"

#include <cmath>

namespace handeye {

namespace {

constexpr std::size_t kExpectedFrames = 4096;  // more than a minute at 60 Hz

}  // namespace

BoardEye::BoardEye(const Board& board, const CameraModel& camera)
    : corners_mm_(board.corners_mm()), camera_(camera) {
  corners_.reserve(corners_mm_.size());
  frames_.reserve(kExpectedFrames);
}

ReconstructionState BoardEye::add(const TrackedFrame& frame) {
  corners_.clear();
  for (const Observation& observation : frame.observations) {
    corners_.push_back({static_cast<int>(observation.feature_id), observation.pixel});
  }
  const auto pose = board_pose(corners_mm_, corners_, camera_);
  if (!pose) return ReconstructionState::kTooFewFeatures;
  const auto count = static_cast<std::int64_t>(corners_.size());
  frames_.push_back({.index = frame.index,
                     .timestamp_ns = frame.timestamp_ns,
                     .eye_from_scene = pose->eye_from_board,
                     .keyframe = true,
                     .reprojection_px = pose->reprojection_px,
                     .inliers = static_cast<int>(count)});
  squares_px2_ += static_cast<double>(count) * pose->reprojection_px * pose->reprojection_px;
  corners_seen_ += count;
  return ReconstructionState::kTracking;
}

Reconstruction BoardEye::current() const {
  Reconstruction result;
  if (frames_.empty()) return result;
  result.state = ReconstructionState::kTracking;
  result.frames = frames_;
  result.points = static_cast<int>(corners_mm_.size());
  result.reprojection_px = std::sqrt(squares_px2_ / static_cast<double>(corners_seen_));
  return result;
}

}  // namespace handeye
