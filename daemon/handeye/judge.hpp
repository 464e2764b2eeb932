// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "daemon/handeye/halves.hpp"
#include "daemon/handeye/maximum_likelihood.hpp"
#include "daemon/handeye/motion_problem.hpp"
#include "daemon/handeye/observability.hpp"

namespace handeye {

struct JudgeOptions {
  double wanted_rotation_deg{0.3};     ///< square root of the trace of w's block
  double wanted_translation_mm{1.5};   ///< likewise of dt's
  double max_log_scale_sigma{0.1};     ///< beyond it the linearised covariance means nothing
  double halves_chi2_by_chance{12.6};  ///< of 6 dof: exceeded once in 20; beyond it is a finding
  /// For the halves; as for the whole. With known scale nothing is asked of the eye's path.
  MaximumLikelihoodOptions solver;
};

/// What is judged where the likelihood's answer was only the start of a better one (one_step.hpp).
struct JudgedAnswer {
  Pose hand_from_eye{Pose::Identity()};
  Matrix6d covariance{Matrix6d::Zero()};  ///< of (w [rad], dt [mm]), as MaximumLikelihoodResult's
  /// Its own, of a whole that has this covariance; nothing: the likelihood's serve, and half their
  /// difference counts in full, for what this answer claims says nothing of them.
  std::optional<HalvesOfWhole> halves;
  /// Its own; believed where its own halves agree. Nothing: from the likelihood's.
  std::optional<double> log_scale_sigma;
};

struct Judgement {
  MotionProblem problem{MotionProblem::kUncertain};  ///< kNone: accepted
  /// Squared Mahalanobis distance between the answers of two halves of the data (6 dof): the first
  /// and the second where they are in order of time, else every other pose. Nothing when a half is
  /// too short.
  std::optional<double> halves_chi2;
  /// Of the answer's hand_from_eye, with what the halves add where chance does not explain their
  /// difference (error_of_whole; of halves that are not its own all of d/2). This, not the answer's
  /// own, is what is accepted or refused.
  Matrix6d covariance{Matrix6d::Zero()};
  Observability observability;  ///< from that covariance
  MissingMotion missing{
      MissingMotion::kNone};  ///< what would help a refused answer; kNone: accepted
};

/// Accepts an answer whose sigmas, the disagreement of its disjoint halves included, are within
/// what was wanted and whose scale is observable, unless parts with more than a fifth of the poses
/// contradicted it and were left out; else names what the motion lacks. `result`: of
/// the same observations; nothing when there is none. Fewer than five poses are never accepted.
Judgement judge(std::span<const HandEyeObservation> observations,
                const std::optional<MaximumLikelihoodResult>& result,
                const JudgeOptions& options = {});

/// The same of `answer`, which the same observations, and what else was seen, led to from `result`.
/// Throws std::invalid_argument for halves of another whole.
Judgement judge(std::span<const HandEyeObservation> observations,
                const MaximumLikelihoodResult& result, const JudgedAnswer& answer,
                const JudgeOptions& options = {});

}  // namespace handeye
