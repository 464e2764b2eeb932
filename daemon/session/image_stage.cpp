// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/image_stage.hpp"

#include <utility>

#include "daemon/session/board_stage.hpp"
#include "daemon/session/stopwatch.hpp"
#include "daemon/session/tracking_stage.hpp"

namespace handeye {

void ImageStage::process(const Frame& frame, TrackedFrame& tracked) {
  const Stopwatch stopwatch;
  look(frame, tracked);
  time_ms_ += stopwatch.elapsed_ms();
}

std::unique_ptr<ImageStage> make_image_stage(const std::optional<Board>& board, cv::Mat mask) {
  if (board) return std::make_unique<BoardStage>(*board);
  return std::make_unique<TrackingStage>(std::move(mask));
}

}  // namespace handeye
