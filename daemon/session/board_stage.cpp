// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/board_stage.hpp"

namespace handeye {

void BoardStage::look(const cv::Mat& grey, std::int64_t /*timestamp_ns*/, TrackedFrame& tracked) {
  detector_->detect(grey, corners_);
  for (const BoardCorner& corner : corners_) {
    tracked.observations.push_back({corner.id, corner.pixel});
  }
}

}  // namespace handeye
