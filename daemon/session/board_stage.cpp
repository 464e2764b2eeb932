// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/board_stage.hpp"

namespace handeye {

void BoardStage::look(const Frame& frame, TrackedFrame& tracked) {
  find_corners(frame);
  tracked.timestamp_ns = frame.timestamp_ns;
  tracked.index = next_index_++;
  tracked.observations.clear();
  for (const BoardCorner& corner : corners_) {
    tracked.observations.push_back({corner.id, corner.pixel});
  }
}

/// What comes from a camera must not end the daemon, whatever it is.
void BoardStage::find_corners(const Frame& frame) {
  try {
    detector_->detect(frame.grey, corners_);
  } catch (const cv::Exception& error) {
    corners_.clear();
    count_failure(error.err);
  }
}

}  // namespace handeye
