// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "daemon/sync/pose_buffer.hpp"

namespace handeye {

/// A sample of the hand on its way to the solver.
struct HandItem {
  std::uint64_t calibration{0};  ///< which begin_collecting() it belongs to
  HandSample sample;
};

/// A sample of the calibrated hand on its way to the watch. What was on its way when another
/// calibration came into use may be of another body.
struct WatchedHand {
  std::int64_t request_id{0};  ///< of the calibration in use
  HandSample sample;
};

}  // namespace handeye
