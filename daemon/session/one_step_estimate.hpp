// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "daemon/handeye/one_step/one_step.hpp"
#include "daemon/reconstruction/reconstruction.hpp"
#include "daemon/session/estimate.hpp"
#include "daemon/session/result.hpp"
#include "daemon/sync/pose_buffer.hpp"

namespace handeye {

/// Hand-eye in one step with everything that was seen (one_step.hpp), and the time offset with it.
struct OneStepEstimate {
  OneStepProblem problem;         ///< as it was solved at last,
  MaximumLikelihoodResult start;  ///< from here,
  OneStepOptions options;         ///< and so
  OneStepResult result;
  HandEyeSolution solution;  ///< its scale is that of the part that the likelihood's is of
  double time_offset_s{0};   ///< camera stamp = tracker stamp + this
  HandNoiseSource hand_noise{HandNoiseSource::kEstimated};  ///< as it was used
  double time_ms{0};
};

/// From the likelihood's answer, which is needed to start; looks the hand up again until the offset
/// stays. A lens that was not given is free, with what was believed of it before the images.
/// `hand_noise`: kMeasured becomes kEstimated where most frames have no covariance from the tracker
/// (6dcov), or where the residuals contradict it. Nothing with a board, whose corners are no
/// structure; where one_step finds none; and where that does not explain the hand
/// (one_step_check.hpp) or its offset does not settle: then it is in a wrong minimum.
/// Deterministic.
std::optional<OneStepEstimate> estimate_in_one_step(const Reconstruction& reconstruction,
                                                    const PoseBuffer& hand, const Estimate& start,
                                                    HandNoiseSource hand_noise);

/// What the result says of the tracker's noise.
SampleNoise hand_noise_of(const OneStepEstimate& estimate);

/// What is known of the lens now; `distortion_px` over all that the keyframes saw.
LensSigma lens_sigma_of(const OneStepEstimate& estimate, const Reconstruction& reconstruction);

}  // namespace handeye
