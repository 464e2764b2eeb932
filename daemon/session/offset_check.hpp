// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "daemon/reconstruction/reconstruction.hpp"
#include "daemon/sync/pose_buffer.hpp"
#include "daemon/sync/time_offset.hpp"

namespace handeye {

/// By the angular speeds of hand and eye (correlate_angular_speed).
std::optional<TimeOffset> correlate(std::span<const RegisteredFrame> frames,
                                    const PoseBuffer& hand);

/// Whether the clocks jumped against each other: where both halves of the frames tell their time
/// offset for sure, and they are far more apart than chance explains.
bool offset_jumped(std::span<const RegisteredFrame> frames, const PoseBuffer& hand);

}  // namespace handeye
