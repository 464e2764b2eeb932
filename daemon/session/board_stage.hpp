// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "daemon/pattern/board_detector.hpp"
#include "daemon/session/image_stage.hpp"

namespace handeye {

/// Finds a board's corners in every image, as BoardEye takes them.
class BoardStage final : public ImageStage {
 public:
  explicit BoardStage(const Board& board) : detector_(make_board_detector(board)) {}
  explicit BoardStage(std::unique_ptr<BoardDetector> detector) : detector_(std::move(detector)) {}

 private:
  void look(const cv::Mat& grey, std::int64_t timestamp_ns, TrackedFrame& tracked) override;

  std::unique_ptr<BoardDetector> detector_;
  std::vector<BoardCorner> corners_;
};

}  // namespace handeye
