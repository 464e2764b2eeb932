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
  /// No one time offset serves all of it (offset_check.hpp).
  bool offset_jumped{false};
  PoseNoise noise;  ///< of the tracker
  WantedSigma wanted;
};

struct Finding {
  Reason reason{Reason::kNone};                 ///< kNone: accept
  MissingMotion missing{MissingMotion::kNone};  ///< of a refused answer: what would help most
  std::optional<Judgement> judgement;           ///< nothing: there was no answer to judge
  Matrix6d covariance{Matrix6d::Zero()};        ///< of the answer judged, the lens's part included
  bool worse_tracker{false};  ///< the answer takes a tracker much worse than this one is said to be
  bool lens_known{true};      ///< false: what is said of the lens must not be believed
};

/// What is wrong with a motion, in the result's words; kNone for kNone.
Reason reason_of(MotionProblem problem);

/// Judges, first match: nothing was seen, the motion was not enough, the images were not, the
/// answer is not certain enough. An answer in one step is weighed by halves of its own, and by the
/// likelihood's answer: where that contradicts it by more than chance, the difference is in the
/// covariance. Nor is an answer certain that takes a tracker much worse than this one is said to
/// be.
Finding conclude(const Evidence& evidence);

}  // namespace handeye
