// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/handeye/one_step/one_step.hpp"
#include "daemon/reconstruction/reconstruction.hpp"
#include "daemon/sync/pose_buffer.hpp"

namespace handeye {

/// All that was seen, as one_step takes it: the frames and the structure of a reconstruction, frame
/// for frame and point for point, and the hand as it was at each frame. `time_offset_s`: camera
/// stamp = tracker stamp + this. A frame that is no keyframe and of which nothing is known how well
/// it was placed is there without a hand.
OneStepProblem one_step_problem(const Reconstruction& reconstruction, const PoseBuffer& hand,
                                double time_offset_s);

}  // namespace handeye
