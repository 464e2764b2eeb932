// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/verdict.hpp"

#include "daemon/session/lens_sensitivity.hpp"

namespace handeye {
namespace {

// Fewer poses than this determine nothing, whatever they are. Of a reconstruction so few would be
// an accident; each view of a board stands by itself.
constexpr std::size_t kFewestPoses = 10;
constexpr std::size_t kFewestBoardPoses = 4;
// Below this share of frames with a visible hand, an uncertain answer is the tracker's fault; of
// frames with a visible board, it is for want of the board.
constexpr double kSeenEnough = 0.5;
// Of 6 degrees of freedom: by chance once in 10 000, were both answers as uncertain as they say.
constexpr double kContradiction = 27.9;
// Of the noise that the tracker was said to have: beyond it the fit has found something else.
constexpr double kMostNoise = 5.0;

bool with_board(const Evidence& evidence) {
  return evidence.estimate.scale == ScaleMode::kKnown;
}

/// What the motion has to do with there being nothing to solve from: its fault comes before the
/// images', unless there was a board to be seen whatever the motion.
MotionProblem problem_without_reconstruction(const Evidence& evidence) {
  if (with_board(evidence)) return MotionProblem::kNone;
  const bool no_parallax = evidence.reconstruction.state == ReconstructionState::kNoParallax;
  const MotionProblem problem =
      classify_hand_motion(evidence.hand_path, evidence.noise, no_parallax);
  return problem == MotionProblem::kNone && no_parallax ? MotionProblem::kNoParallax : problem;
}

JudgeOptions options_for(const Evidence& evidence) {
  JudgeOptions options;
  options.wanted_rotation_deg = evidence.wanted.rotation_deg;
  options.wanted_translation_mm = evidence.wanted.translation_mm;
  options.solver = evidence.estimate.options;
  return options;
}

/// Of the likelihood's answer, without what an uncertain lens adds.
Judgement judged_likelihood(const Evidence& evidence) {
  return judge(evidence.estimate.observations, evidence.estimate.likelihood, options_for(evidence));
}

Judgement judged_one_step(const Evidence& evidence) {
  const OneStepEstimate& found = *evidence.one_step;
  const JudgedAnswer answer{
      .hand_from_eye = found.solution.hand_from_eye,
      .covariance = found.result.covariance,
      .halves = compare_halves(found.problem, found.start, found.result, found.options),
      .log_scale_sigma = found.result.log_scale_sigma};
  return judge(evidence.estimate.observations, *evidence.estimate.likelihood, answer,
               options_for(evidence));
}

/// What the likelihood's answer, by all that it claims, its halves and the lens say, speaks against
/// the one in one step: nothing within chance; else one of them is wrong, by as much as they
/// differ.
Matrix6d contradiction(const Evidence& evidence, const Matrix6d& of_one_step) {
  if (!evidence.lens_covariance) return Matrix6d::Zero();
  const HalvesComparison against =
      compare(evidence.one_step->solution.hand_from_eye,
              evidence.estimate.likelihood->solution.hand_from_eye,
              judged_likelihood(evidence).covariance + *evidence.lens_covariance + of_one_step);
  if (against.chi2 <= kContradiction) return Matrix6d::Zero();
  return against.difference * against.difference.transpose();
}

/// The answer's judgement; its covariance with all that speaks against it, and the lens's share,
/// which in one step, where the lens is free, is in there.
Judgement judged(const Evidence& evidence) {
  if (!evidence.one_step) {
    Judgement judgement = judged_likelihood(evidence);
    judgement.covariance += evidence.lens_covariance.value_or(Matrix6d::Zero());
    return judgement;
  }
  Judgement judgement = judged_one_step(evidence);
  judgement.covariance += contradiction(evidence, judgement.covariance);
  return judgement;
}

/// Whether the answer can only be right if the tracker is far worse than it was said to be. What
/// the tracker itself says of its measurements is believed; a board's noise is not the tracker's.
bool takes_a_worse_tracker(const Evidence& evidence) {
  const auto& likelihood = evidence.estimate.likelihood;
  if (!likelihood || with_board(evidence)) return false;
  PoseNoise noise = likelihood->noise;
  if (evidence.one_step) {
    if (evidence.one_step->hand_noise == HandNoiseSource::kMeasured) return false;
    noise.hand_rotation_rad = evidence.one_step->result.hand_rotation_sigma_rad;
    noise.hand_translation_mm = evidence.one_step->result.hand_translation_sigma_mm;
  }
  return noise.hand_rotation_rad > kMostNoise * evidence.noise.hand_rotation_rad ||
         noise.hand_translation_mm > kMostNoise * evidence.noise.hand_translation_mm;
}

/// Whether the scope moved well enough, and the board was out of view while it did.
bool looked_past_board(const Evidence& evidence) {
  const auto registered = static_cast<double>(evidence.reconstruction.frames.size());
  if (!with_board(evidence) ||
      registered >= kSeenEnough * static_cast<double>(evidence.frames_received)) {
    return false;
  }
  const MotionProblem problem = classify_hand_motion(evidence.hand_path, evidence.noise);
  // Against a board, turning about a fixed point is good enough.
  return problem == MotionProblem::kNone || problem == MotionProblem::kFixedPoint;
}

/// Whether the lens was given, or found and not contradicted by the hand.
bool lens_is_known(const Evidence& evidence) {
  const Lens& lens = evidence.reconstruction.lens;
  if (lens.mode == IntrinsicsMode::kFixed) return true;
  return lens.observable && (evidence.one_step || evidence.lens_covariance) &&
         !hand_contradicts_lens(evidence.estimate.observations);
}

bool is_wanted(const Matrix6d& covariance, const WantedSigma& wanted) {
  return sigma_rotation_deg(covariance) <= wanted.rotation_deg &&
         sigma_translation_mm(covariance) <= wanted.translation_mm;
}

/// The judgement in the result's words; devices are blamed for what a motion cannot mend.
Reason reason_after(MotionProblem problem, const Evidence& evidence) {
  if (problem != MotionProblem::kNone && looked_past_board(evidence)) {
    return Reason::kTooFewFeatures;
  }
  const bool names_the_motion =
      problem == MotionProblem::kNoMotion || problem == MotionProblem::kInsufficientRotation ||
      problem == MotionProblem::kNoParallax || problem == MotionProblem::kSingleAxis;
  if (names_the_motion) return reason_of(problem);
  if (!lens_is_known(evidence)) return Reason::kLensUnobservable;
  // At a wrong offset the rest of the judgement means nothing.
  if (!evidence.estimate.has_time_offset() || evidence.offset_jumped) {
    return Reason::kClockUnstable;
  }
  const auto seen = static_cast<double>(evidence.estimate.observations.size());
  const auto registered = static_cast<double>(evidence.reconstruction.frames.size());
  if (problem == MotionProblem::kUncertain && seen < kSeenEnough * registered) {
    return Reason::kTrackerLost;
  }
  return reason_of(problem);
}

/// The images' fault instead, where most of them showed nothing and that may be why. A scope held
/// still is not told from a picture that stands still.
Reason or_the_images(Reason reason, const Evidence& evidence) {
  if (reason == Reason::kNone) return reason;
  switch (evidence.images.prevailing()) {
    case ImageCondition::kUnusable:
      return Reason::kCameraLost;
    case ImageCondition::kDark:
      return Reason::kImageDark;
    case ImageCondition::kFrozen:
      return reason == Reason::kNoMotion ? reason : Reason::kImageFrozen;
    default:
      return reason;
  }
}

/// Whether another motion would have helped.
bool blames_the_motion(Reason reason) {
  switch (reason) {
    case Reason::kNoMotion:
    case Reason::kInsufficientRotation:
    case Reason::kInsufficientTranslation:
    case Reason::kNoParallax:
    case Reason::kSingleAxis:
    case Reason::kFixedPoint:
    case Reason::kUncertain:
      return true;
    default:
      return false;
  }
}

Finding without_answer(Reason reason, MissingMotion missing = MissingMotion::kNone) {
  return {.reason = reason,
          .missing = blames_the_motion(reason) ? missing : MissingMotion::kNone,
          .judgement = {}};
}

Finding without_reconstruction(const Evidence& evidence) {
  const MotionProblem problem = problem_without_reconstruction(evidence);
  const Reason reason =
      problem == MotionProblem::kNone ? Reason::kTooFewFeatures : reason_of(problem);
  return without_answer(or_the_images(reason, evidence), remedy(problem));
}

}  // namespace

Reason reason_of(MotionProblem problem) {
  switch (problem) {
    case MotionProblem::kNone:
      return Reason::kNone;
    case MotionProblem::kNoMotion:
      return Reason::kNoMotion;
    case MotionProblem::kInsufficientRotation:
      return Reason::kInsufficientRotation;
    case MotionProblem::kNoParallax:
      return Reason::kNoParallax;
    case MotionProblem::kSingleAxis:
      return Reason::kSingleAxis;
    case MotionProblem::kFixedPoint:
      return Reason::kFixedPoint;
    case MotionProblem::kUncertain:
      break;
  }
  return Reason::kUncertain;
}

Finding conclude(const Evidence& evidence) {
  if (evidence.frames_received == 0) return without_answer(Reason::kCameraLost);
  if (evidence.hand_path.empty()) return without_answer(Reason::kTrackerLost);
  const std::size_t fewest = with_board(evidence) ? kFewestBoardPoses : kFewestPoses;
  if (evidence.reconstruction.frames.size() < fewest) return without_reconstruction(evidence);
  if (evidence.estimate.observations.size() < fewest) return without_answer(Reason::kTrackerLost);
  const Judgement judgement = judged(evidence);
  const bool worse_tracker = takes_a_worse_tracker(evidence);
  MotionProblem problem = judgement.problem;
  if (problem == MotionProblem::kNone &&
      (!is_wanted(judgement.covariance, evidence.wanted) || worse_tracker)) {
    problem = MotionProblem::kUncertain;
  }
  const Reason reason = or_the_images(reason_after(problem, evidence), evidence);
  return {.reason = reason,
          .missing = blames_the_motion(reason) ? judgement.missing : MissingMotion::kNone,
          .judgement = judgement,
          .covariance = judgement.covariance,
          .worse_tracker = worse_tracker,
          .lens_known = lens_is_known(evidence)};
}

}  // namespace handeye
