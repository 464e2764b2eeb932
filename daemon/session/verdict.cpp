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

bool with_board(const Evidence& evidence) {
  return evidence.estimate.scale == ScaleMode::kKnown;
}

/// Why there is nothing to solve from: the motion's fault before the images', unless there was a
/// board to be seen whatever the motion.
Reason reason_without_reconstruction(const Evidence& evidence) {
  if (with_board(evidence)) return Reason::kTooFewFeatures;
  const bool no_parallax = evidence.reconstruction.state == ReconstructionState::kNoParallax;
  const MotionProblem problem =
      classify_hand_motion(evidence.hand_path, evidence.noise, no_parallax);
  if (problem != MotionProblem::kNone) return reason_of(problem);
  return no_parallax ? Reason::kNoParallax : Reason::kTooFewFeatures;
}

Judgement judged(const Evidence& evidence) {
  JudgeOptions options;
  options.wanted_rotation_deg = evidence.wanted.rotation_deg;
  options.wanted_translation_mm = evidence.wanted.translation_mm;
  options.solver = evidence.estimate.options;
  return judge(evidence.estimate.observations, evidence.estimate.likelihood, options);
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
  return lens.observable && evidence.lens_covariance &&
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
  if (!evidence.estimate.correlation && !evidence.estimate.stood_still) {
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
  if (evidence.frames_received == 0) return {Reason::kCameraLost, {}};
  if (evidence.hand_path.empty()) return {Reason::kTrackerLost, {}};
  const std::size_t fewest = with_board(evidence) ? kFewestBoardPoses : kFewestPoses;
  if (evidence.reconstruction.frames.size() < fewest) {
    return {or_the_images(reason_without_reconstruction(evidence), evidence), {}};
  }
  if (evidence.estimate.observations.size() < fewest) return {Reason::kTrackerLost, {}};
  const Judgement judgement = judged(evidence);
  const Matrix6d covariance =
      judgement.covariance + evidence.lens_covariance.value_or(Matrix6d::Zero());
  MotionProblem problem = judgement.problem;
  if (problem == MotionProblem::kNone && !is_wanted(covariance, evidence.wanted)) {
    problem = MotionProblem::kUncertain;
  }
  return {or_the_images(reason_after(problem, evidence), evidence), judgement, covariance,
          lens_is_known(evidence)};
}

}  // namespace handeye
