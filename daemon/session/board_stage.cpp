// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/board_stage.hpp"

namespace handeye {

void BoardStage::look(const cv::Mat& grey, std::int64_t /*timestamp_ns*/, TrackedFrame& tracked) {
  find_corners(grey);
  for (const BoardCorner& corner : corners_) {
    tracked.observations.push_back({corner.id, corner.pixel});
  }
}

/// What comes from a camera must not end the daemon, whatever it is.
void BoardStage::find_corners(const cv::Mat& grey) {
  try {
    detector_->detect(grey, corners_);
  } catch (const cv::Exception& error) {
    corners_.clear();
    count_failure(error.err);
  }
}

}  // namespace handeye
