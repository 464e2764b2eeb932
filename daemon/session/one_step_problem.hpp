// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "daemon/handeye/one_step/one_step.hpp"
#include "daemon/reconstruction/reconstruction.hpp"
#include "daemon/sync/hand_smoothing.hpp"
#include "daemon/sync/pose_buffer.hpp"

namespace handeye {

/// The hand as frames at such times need it: by the samples within one and a half of their periods,
/// at most 60 ms. Borrows `hand`.
HandSmoothing smoothed_for(const std::vector<RegisteredFrame>& frames, const PoseBuffer& hand);

/// All that was seen, as one_step takes it: the frames and the structure of a reconstruction, frame
/// for frame and point for point, and the hand as it was at each frame. `time_offset_s`: camera
/// stamp = tracker stamp + this. A frame that is no keyframe and of which nothing is known how well
/// it was placed is there without a hand.
OneStepProblem one_step_problem(const Reconstruction& reconstruction, const HandSmoothing& hand,
                                double time_offset_s);

}  // namespace handeye
