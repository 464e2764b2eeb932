// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/board_stage.hpp"

namespace handeye {

void BoardStage::look(const Frame& frame, TrackedFrame& tracked) {
  detector_->detect(frame.grey, corners_);
  tracked.timestamp_ns = frame.timestamp_ns;
  tracked.index = next_index_++;
  tracked.observations.clear();
  for (const BoardCorner& corner : corners_) {
    tracked.observations.push_back({corner.id, corner.pixel});
  }
}

}  // namespace handeye
