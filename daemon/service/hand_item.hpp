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

}  // namespace handeye
