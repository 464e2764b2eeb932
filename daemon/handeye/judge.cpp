// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/judge.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include "daemon/handeye/motion_facts.hpp"
#include "daemon/handeye/parts.hpp"
#include "daemon/handeye/usable.hpp"

namespace handeye {
namespace {

// These only choose the words for a motion that did not suffice; what suffices is for the
// covariance.
constexpr double kAboveNoise = 5.0;         // standard deviations
constexpr double kStillRotation_deg = 0.3;  // rms of a hand that is kept still
constexpr double kStillPath_mm = 0.75;
constexpr double kMinRotation_deg = 2.0;   // rms; less is the wobble of a straight movement
constexpr double kMinSecondAxis = 0.12;    // second principal turn to the first
constexpr double kMaxPivotShare = 0.05;    // of the path left by the best fixed point: a pivot
constexpr double kExplained = 0.5;         // of the eye's path by a fixed point: no mere noise
constexpr double kScaleShare = 0.5;        // of the translation's variance that is the scale's
constexpr std::size_t kMinHalf = 5;        // poses
constexpr std::size_t kMinPoses = 5;       // fewer hardly contradict any answer
constexpr double kMaxContradicting = 0.2;  // share of the poses, in parts that were left out

/// Of hand and eye, over poses that share a scene.
struct Motion {
  MotionFacts hand;
  MotionFacts eye;
};

bool pivots(const MotionFacts& hand, const PoseNoise& noise) {
  return hand.pivot_rms <
         std::max(kAboveNoise * noise.hand_translation_mm, kMaxPivotShare * hand.path_rms);
}

/// The hand turns about the camera's centre: it pivots, and the eye's own path is no consequence of
/// its turning, hence noise.
bool turns_about_camera(const Motion& motion, const PoseNoise& noise) {
  return pivots(motion.hand, noise) && motion.eye.pivot_rms >= kExplained * motion.eye.path_rms;
}

/// `without_parallax`: the camera was seen to turn on the spot.
MotionProblem classify(const MotionFacts& hand, const PoseNoise& noise, bool without_parallax,
                       ScaleMode scale) {
  const Eigen::Vector3d& turn = hand.principal_rotation_rad;
  const double noise_turn = kAboveNoise * noise.hand_rotation_rad;
  const bool turns = turn.norm() > std::max(noise_turn, rad_from_deg(kStillRotation_deg));
  const bool moves =
      hand.path_rms > std::max(kAboveNoise * noise.hand_translation_mm, kStillPath_mm);
  if (!turns && !moves) return MotionProblem::kNoMotion;
  if (turn[0] < std::max(noise_turn, rad_from_deg(kMinRotation_deg))) {
    return MotionProblem::kInsufficientRotation;
  }
  if (without_parallax) return MotionProblem::kNoParallax;
  if (turn[1] < std::max(noise_turn, kMinSecondAxis * turn[0])) return MotionProblem::kSingleAxis;
  if (scale == ScaleMode::kUnknown && pivots(hand, noise)) return MotionProblem::kFixedPoint;
  return MotionProblem::kNone;
}

/// Where one part's reconstruction contradicts the others', something is wrong; who is right is a
/// question of how many.
bool contradicts_itself(const MaximumLikelihoodResult& result) {
  std::size_t used = 0;
  std::size_t left_out = 0;
  for (const PartResult& part : result.parts) {
    if (part.poses_used > 0) {
      used += part.poses;
    } else if (part.poses >= kFewestPosesOfPart) {
      left_out += part.poses;
    }
  }
  return static_cast<double>(left_out) > kMaxContradicting * static_cast<double>(used + left_out);
}

/// An answer, and the halves that speak of it.
struct Weighed {
  const JudgedAnswer& answer;
  std::optional<HalvesComparison> halves;
  bool own_halves{true};  ///< false: another answer's, to the same data

  bool agrees(const JudgeOptions& options) const {
    return own_halves && halves && halves->chi2 <= options.halves_chi2_by_chance;
  }
};

/// Of the likelihood, in the part whose scale it knows best: through hand_from_eye it serves the
/// others.
double log_scale_sigma(const MaximumLikelihoodResult& result) {
  double least = result.log_scale_sigma;
  for (const PartResult& part : result.parts) {
    if (part.poses_used > 0) least = std::min(least, part.log_scale_sigma);
  }
  return least;
}

/// What another answer knows better of the scale is believed only where its halves agree. It may
/// say so itself; else it is what it knows better of the translation, which hangs on the scale.
double log_scale_sigma(const MaximumLikelihoodResult& result, const Matrix6d& covariance,
                       const Weighed& weighed, const JudgeOptions& options) {
  const double of_likelihood = log_scale_sigma(result);
  if (!weighed.agrees(options)) {
    return std::max(of_likelihood, weighed.answer.log_scale_sigma.value_or(0.0));
  }
  if (weighed.answer.log_scale_sigma) return *weighed.answer.log_scale_sigma;
  const double known = sigma_translation_mm(covariance) / result.sigma_translation_mm();
  return of_likelihood * std::min(known, 1.0);
}

/// Whether the unknown scale is what makes the translation uncertain: its share of the variance is
/// the likelihood's, the variance the answer's.
bool scale_is_to_blame(const MaximumLikelihoodResult& result, const Weighed& weighed,
                       const JudgeOptions& options) {
  const Matrix6d& covariance = weighed.answer.covariance;
  const double sigma = result.sigma_translation_mm();
  const double known = result.sigma_translation_known_scale_mm;
  return log_scale_sigma(result, covariance, weighed, options) > options.max_log_scale_sigma ||
         (options.solver.estimate_scale &&
          sigma_translation_mm(covariance) > options.wanted_translation_mm &&
          known * known < (1.0 - kScaleShare) * sigma * sigma);
}

/// What the answer is worth.
Judgement worth(const Weighed& weighed, const JudgeOptions& options) {
  Judgement judgement;
  judgement.covariance = weighed.answer.covariance;
  if (weighed.halves) {
    judgement.halves_chi2 = weighed.halves->chi2;
    if (weighed.halves->chi2 > options.halves_chi2_by_chance) {
      const Vector6d error = weighed.own_halves
                                 ? error_of_whole(*weighed.halves, weighed.answer.covariance)
                                 : Vector6d(0.5 * weighed.halves->difference);
      judgement.covariance += error * error.transpose();
    }
  }
  judgement.observability = observability(judgement.covariance);
  return judgement;
}

bool suffices(const Matrix6d& covariance, const MaximumLikelihoodResult& result,
              const Weighed& weighed, const JudgeOptions& options) {
  return covariance.allFinite() && sigma_rotation_deg(covariance) <= options.wanted_rotation_deg &&
         sigma_translation_mm(covariance) <= options.wanted_translation_mm &&
         log_scale_sigma(result, covariance, weighed, options) <= options.max_log_scale_sigma &&
         !contradicts_itself(result);
}

/// In every part that counts.
bool turns_about_camera(std::span<const HandEyeObservation> observations, const PoseNoise& noise) {
  const std::vector<Part> parts = parts_of(observations);
  return std::ranges::all_of(parts, [&](const Part& part) {
    const bool counts =
        part.number == parts.front().number || part.members.size() >= kFewestPosesOfPart;
    if (!counts) return true;
    std::vector<Pose> hand;
    std::vector<Pose> eye;
    for (const PosePair& pair : poses_of(observations, part)) {
      hand.push_back(pair.room_from_hand);
      eye.push_back(pair.eye_from_scene.inverse());
    }
    return turns_about_camera({motion_facts(hand), motion_facts(eye)}, noise);
  });
}

/// What is wrong with a motion that did not suffice. `scale_to_blame`: nothing where there is no
/// answer to tell.
MotionProblem problem_of(std::span<const HandEyeObservation> observations,
                         std::optional<bool> scale_to_blame, const JudgeOptions& options) {
  std::vector<HandEyeObservation> usable;
  std::vector<Pose> hand;
  for (const HandEyeObservation& observation : observations) {
    if (!are_usable({&observation.poses, 1})) continue;
    usable.push_back(observation);
    hand.push_back(observation.poses.room_from_hand);
  }
  const ScaleMode scale = options.solver.estimate_scale ? ScaleMode::kUnknown : ScaleMode::kKnown;
  const PoseNoise& noise = options.solver.noise;
  const bool on_the_spot =
      scale == ScaleMode::kUnknown && !usable.empty() && turns_about_camera(usable, noise);
  const MotionProblem problem = classify(motion_facts(hand), noise, on_the_spot, scale);
  if (problem != MotionProblem::kFixedPoint && problem != MotionProblem::kNone) return problem;
  // The sigma of the scale decides whether a pivot is to blame, not how the motion looks.
  const bool pivot = scale_to_blame.value_or(problem == MotionProblem::kFixedPoint);
  return pivot ? MotionProblem::kFixedPoint : MotionProblem::kUncertain;
}

/// By what the motion determines, whatever the halves say.
MissingMotion missing_motion(std::span<const HandEyeObservation> observations,
                             const JudgedAnswer& answer, MotionProblem problem,
                             const JudgeOptions& options) {
  // Which axis: only where there are turns to know the camera's axes by, and an axis can help.
  if (problem != MotionProblem::kSingleAxis && problem != MotionProblem::kUncertain) {
    return remedy(problem);
  }
  const Observability weakest = observability(answer.covariance);
  const bool rotation_first =
      sigma_rotation_deg(answer.covariance) / options.wanted_rotation_deg >
      sigma_translation_mm(answer.covariance) / options.wanted_translation_mm;
  const Observability::Direction& weak =
      rotation_first ? weakest.rotation_deg : weakest.translation_mm;
  return missing_turn(observations, answer.hand_from_eye, weak.axis_in_hand);
}

Judgement judge(std::span<const HandEyeObservation> observations,
                const MaximumLikelihoodResult& result, const Weighed& weighed,
                const JudgeOptions& options) {
  Judgement judgement = worth(weighed, options);
  const bool enough = result.poses_used >= kMinPoses;
  const bool two_halves = weighed.halves || result.poses_used < 2 * kMinHalf;
  if (enough && two_halves && suffices(judgement.covariance, result, weighed, options)) {
    judgement.problem = MotionProblem::kNone;
    return judgement;
  }
  // Precise by itself: the motion was enough, and the halves disagree.
  const JudgedAnswer& answer = weighed.answer;
  const bool uncertain = enough && suffices(answer.covariance, result, weighed, options);
  judgement.problem =
      uncertain ? MotionProblem::kUncertain
                : problem_of(observations, scale_is_to_blame(result, weighed, options), options);
  judgement.missing = missing_motion(observations, answer, judgement.problem, options);
  return judgement;
}

/// Nothing when a half is too short.
std::optional<HalvesComparison> halves_of(std::span<const HandEyeObservation> observations,
                                          const MaximumLikelihoodResult& result,
                                          const JudgeOptions& options) {
  if (result.poses_used < 2 * kMinHalf) return std::nullopt;
  return compare_halves(observations, result, options.solver);
}

}  // namespace

Judgement judge(std::span<const HandEyeObservation> observations,
                const MaximumLikelihoodResult& result, const JudgedAnswer& answer,
                const JudgeOptions& options) {
  if (answer.halves) return judge(observations, result, Weighed{answer, answer.halves}, options);
  return judge(observations, result,
               Weighed{answer, halves_of(observations, result, options), false}, options);
}

Judgement judge(std::span<const HandEyeObservation> observations,
                const std::optional<MaximumLikelihoodResult>& result, const JudgeOptions& options) {
  if (result) {
    const JudgedAnswer answer{result->solution.hand_from_eye, result->covariance, {}, {}};
    return judge(observations, *result, Weighed{answer, halves_of(observations, *result, options)},
                 options);
  }
  Judgement judgement;
  judgement.problem = problem_of(observations, std::nullopt, options);
  judgement.missing = remedy(judgement.problem);
  return judgement;
}

MotionProblem classify_hand_motion(std::span<const Pose> room_from_hand, const PoseNoise& noise,
                                   bool images_without_parallax) {
  return classify(motion_facts(room_from_hand), noise, images_without_parallax,
                  ScaleMode::kUnknown);
}

MissingMotion remedy(MotionProblem problem) {
  switch (problem) {
    case MotionProblem::kNone:
      return MissingMotion::kNone;
    case MotionProblem::kNoMotion:
    case MotionProblem::kInsufficientRotation:
      return MissingMotion::kTiltUpAndDown;
    case MotionProblem::kNoParallax:
      return MissingMotion::kSlideSideways;
    case MotionProblem::kFixedPoint:
      return MissingMotion::kSlideInAndOut;
    case MotionProblem::kSingleAxis:
    case MotionProblem::kUncertain:
      break;
  }
  return MissingMotion::kKeepMoving;
}

}  // namespace handeye
