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
  bool stood_still{false};  ///< no correlation, and none needed: the hand rested at every frame
  double time_offset_s{0};  ///< camera stamp = tracker stamp + this; refined
  double time_offset_sigma_s{0};
  std::optional<MaximumLikelihoodResult> likelihood;  ///< nothing: the data do not determine any
  MaximumLikelihoodOptions options;                   ///< it was solved with
  ScaleMode scale{ScaleMode::kUnknown};               ///< of the eye's translations
  double time_ms{0};

  /// False: the hand was looked up at an offset that nothing speaks for, and the answer is off by
  /// what it moved in the true one, whatever is claimed of it.
  bool has_time_offset() const { return correlation || stood_still; }
};

/// The hand at each frame, of whatever part, looked up at the given time offset; frames without are
/// left out.
std::vector<HandEyeObservation> observe(std::span<const RegisteredFrame> frames,
                                        const PoseBuffer& hand, double time_offset_s);

/// For what knows but one scene: the poses of the part whose scale the answer has, the largest one
/// where there is no answer.
std::vector<PosePair> poses_of_answer(const Estimate& estimate);

/// Finds the time offset by correlation, solves by maximum likelihood with the offset free, and
/// looks the hand up again until the offset stays. Without a correlation the offset is held at 0,
/// which is as good as any where the hand rested at every frame. Deterministic.
Estimate estimate(std::span<const RegisteredFrame> frames, const PoseBuffer& hand,
                  const PoseNoise& noise, ScaleMode scale = ScaleMode::kUnknown);

}  // namespace handeye
