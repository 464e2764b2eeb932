// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "daemon/handeye/maximum_likelihood.hpp"
#include "daemon/reconstruction/reconstruction.hpp"
#include "daemon/sync/pose_buffer.hpp"
#include "daemon/sync/time_offset.hpp"

namespace handeye {

/// Hand and eye brought together: the time offset, and hand-eye at that offset.
struct Estimate {
  /// The frames for which the tracker saw the hand, at the final time offset.
  std::vector<HandEyeObservation> observations;
  std::optional<TimeOffset> correlation;  ///< nothing: not found; the offset below starts from 0
  double time_offset_s{0};                ///< camera stamp = tracker stamp + this; refined
  double time_offset_sigma_s{0};
  std::optional<MaximumLikelihoodResult> likelihood;  ///< nothing: the data do not determine any
  MaximumLikelihoodOptions options;                   ///< it was solved with
  double time_ms{0};
};

/// The hand at each frame, looked up at the given time offset; frames without are left out.
std::vector<HandEyeObservation> observe(std::span<const RegisteredFrame> frames,
                                        const PoseBuffer& hand, double time_offset_s);

/// Finds the time offset by correlation, solves by maximum likelihood with the offset free, and
/// looks the hand up again until the offset stays. Deterministic.
Estimate estimate(std::span<const RegisteredFrame> frames, const PoseBuffer& hand,
                  const PoseNoise& noise);

}  // namespace handeye
