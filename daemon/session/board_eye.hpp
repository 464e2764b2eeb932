// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/pattern/board_pose.hpp"
#include "daemon/session/eye_source.hpp"

namespace handeye {

/// The eye's poses from a board: each frame by itself, in mm. A TrackedFrame's observations are the
/// board's corners, feature_id their index into Board::corners_mm(). Frames whose corners determine
/// no pose are left out; the others are all keyframes.
class BoardEye final : public EyeSource {
 public:
  BoardEye(const Board& board, const CameraModel& camera);

  ScaleMode scale() const override { return ScaleMode::kKnown; }
  /// kTooFewFeatures: the board could not be located in this frame.
  ReconstructionState add(const TrackedFrame& frame) override;
  Reconstruction current() const override;
  Reconstruction finish() override { return current(); }
  int keyframes() const override { return static_cast<int>(frames_.size()); }

 private:
  std::vector<Eigen::Vector3d> corners_mm_;
  CameraModel camera_;
  std::vector<BoardCorner> corners_;  ///< of the frame at hand
  std::vector<RegisteredFrame> frames_;
  double squares_px2_{0};  ///< of all reprojection errors
  std::int64_t corners_seen_{0};
};

}  // namespace handeye
