// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "daemon/handeye/judge.hpp"
#include "daemon/handeye/types.hpp"
#include "daemon/reconstruction/reconstruction.hpp"
#include "daemon/session/estimate.hpp"
#include "daemon/session/image_health.hpp"
#include "daemon/session/one_step_estimate.hpp"
#include "daemon/session/result.hpp"

namespace handeye {

/// Everything a verdict rests on.
struct Evidence {
  std::int64_t frames_received{0};
  const ImageHealth& images;
  std::span<const Pose> hand_path;  ///< room_from_hand, wherever it was tracked
  const Reconstruction& reconstruction;
  const Estimate& estimate;
  const std::optional<OneStepEstimate>& one_step;  ///< nothing: the answer is the likelihood's
  /// What an uncertain lens adds to the likelihood's hand_from_eye; nothing: not known.
  std::optional<Matrix6d> lens_covariance{Matrix6d::Zero()};
  PoseNoise noise;  ///< of the tracker
  WantedSigma wanted;
};

struct Finding {
  Reason reason{Reason::kNone};                 ///< kNone: accept
  MissingMotion missing{MissingMotion::kNone};  ///< of a refused answer: what would help most
  std::optional<Judgement> judgement;           ///< nothing: there was no answer to judge
  Matrix6d covariance{Matrix6d::Zero()};        ///< of the answer judged, the lens's part included
  bool lens_known{true};  ///< false: what is said of the lens must not be believed
};

/// What is wrong with a motion, in the result's words; kNone for kNone.
Reason reason_of(MotionProblem problem);

/// Judges, first match: nothing was seen, the motion was not enough, the images were not, the
/// answer is not certain enough.
Finding conclude(const Evidence& evidence);

}  // namespace handeye
