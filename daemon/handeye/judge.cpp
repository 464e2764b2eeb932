// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/judge.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include "daemon/handeye/motion_facts.hpp"
#include "daemon/handeye/usable.hpp"

namespace handeye {
namespace {

// These only choose the words for a motion that did not suffice; what suffices is for the
// covariance.
constexpr double kAboveNoise = 5.0;         // standard deviations
constexpr double kStillRotation_deg = 0.3;  // rms of a hand that is kept still
constexpr double kStillPath_mm = 0.75;
constexpr double kMinRotation_deg = 2.0;  // rms; less is the wobble of a straight movement
constexpr double kMinSecondAxis = 0.12;   // second principal turn to the first
constexpr double kMaxPivotShare = 0.05;   // of the path left by the best fixed point: a pivot
constexpr double kExplained = 0.5;        // of the eye's path by a fixed point: no mere noise
constexpr double kScaleShare = 0.5;       // of the translation's variance that is the scale's
constexpr std::size_t kMinHalf = 5;       // poses
constexpr std::size_t kMinPoses = 5;      // fewer hardly contradict any answer

bool pivots(const MotionFacts& hand, const PoseNoise& noise) {
  return hand.pivot_rms <
         std::max(kAboveNoise * noise.hand_translation_mm, kMaxPivotShare * hand.path_rms);
}

/// The hand turns about the camera's centre: it pivots, and the eye's own path is no consequence of
/// its turning, hence noise.
bool turns_about_camera(const MotionFacts& hand, const MotionFacts& eye, const PoseNoise& noise) {
  return pivots(hand, noise) && eye.pivot_rms >= kExplained * eye.path_rms;
}

MotionProblem classify(const MotionFacts& hand, const MotionFacts* eye, const PoseNoise& noise,
                       bool images_without_parallax, ScaleMode scale) {
  const Eigen::Vector3d& turn = hand.principal_rotation_rad;
  const double noise_turn = kAboveNoise * noise.hand_rotation_rad;
  const bool turns = turn.norm() > std::max(noise_turn, rad_from_deg(kStillRotation_deg));
  const bool moves =
      hand.path_rms > std::max(kAboveNoise * noise.hand_translation_mm, kStillPath_mm);
  if (!turns && !moves) return MotionProblem::kNoMotion;
  if (turn[0] < std::max(noise_turn, rad_from_deg(kMinRotation_deg))) {
    return MotionProblem::kInsufficientRotation;
  }
  const bool scale_is_unknown = scale == ScaleMode::kUnknown;
  if (images_without_parallax ||
      (scale_is_unknown && eye && turns_about_camera(hand, *eye, noise))) {
    return MotionProblem::kNoParallax;
  }
  if (turn[1] < std::max(noise_turn, kMinSecondAxis * turn[0])) return MotionProblem::kSingleAxis;
  if (scale_is_unknown && pivots(hand, noise)) return MotionProblem::kFixedPoint;
  return MotionProblem::kNone;
}

/// Whether the unknown scale is what makes the translation uncertain.
bool scale_is_to_blame(const MaximumLikelihoodResult& result, const JudgeOptions& options) {
  const double sigma = result.sigma_translation_mm();
  const double known = result.sigma_translation_known_scale_mm;
  return result.log_scale_sigma > options.max_log_scale_sigma ||
         (options.solver.estimate_scale && sigma > options.wanted_translation_mm &&
          known * known < (1.0 - kScaleShare) * sigma * sigma);
}

struct HalvesComparison {
  Vector6d difference;  ///< (w [rad], dt [mm]) from the second half's answer to the first's
  double chi2{0};
};

struct Halves {
  std::vector<HandEyeObservation> first;
  std::vector<HandEyeObservation> second;
};

/// In order of time the first and the second half, which something that slipped sets apart; else
/// every other one.
Halves halves_of(std::span<const HandEyeObservation> observations, bool in_order_of_time) {
  Halves halves;
  for (std::size_t k = 0; k < observations.size(); ++k) {
    const bool first = in_order_of_time ? k < observations.size() / 2 : k % 2 == 0;
    (first ? halves.first : halves.second).push_back(observations[k]);
  }
  return halves;
}

std::optional<HalvesComparison> compare_halves(std::span<const HandEyeObservation> observations,
                                               const HandEyeSolution& start,
                                               const JudgeOptions& options) {
  const Halves halves = halves_of(observations, options.solver.account_for_correlation);
  const auto first = maximum_likelihood(halves.first, start, options.solver);
  const auto second = maximum_likelihood(halves.second, start, options.solver);
  if (!first || !second) return std::nullopt;
  HalvesComparison comparison;
  comparison.difference << log_so3(first->solution.hand_from_eye.linear() *
                                   second->solution.hand_from_eye.linear().transpose()),
      first->solution.hand_from_eye.translation() - second->solution.hand_from_eye.translation();
  const Matrix6d covariance = first->covariance + second->covariance;
  comparison.chi2 = comparison.difference.dot(covariance.ldlt().solve(comparison.difference));
  return comparison;
}

/// What the answer is worth.
void weigh(std::span<const HandEyeObservation> observations, const MaximumLikelihoodResult& result,
           const JudgeOptions& options, Judgement& judgement) {
  judgement.covariance = result.covariance;
  if (result.poses_used >= 2 * kMinHalf) {
    if (const auto halves = compare_halves(observations, result.solution, options)) {
      judgement.halves_chi2 = halves->chi2;
      if (halves->chi2 > options.halves_chi2_by_chance) {
        judgement.covariance += 0.25 * halves->difference * halves->difference.transpose();
      }
    }
  }
  judgement.observability = observability(judgement.covariance);
}

bool suffices(const Matrix6d& covariance, const MaximumLikelihoodResult& result,
              const JudgeOptions& options) {
  return covariance.allFinite() && sigma_rotation_deg(covariance) <= options.wanted_rotation_deg &&
         sigma_translation_mm(covariance) <= options.wanted_translation_mm &&
         result.log_scale_sigma <= options.max_log_scale_sigma;
}

/// What is wrong with a motion that did not suffice.
MotionProblem problem_of(std::span<const HandEyeObservation> observations,
                         const std::optional<MaximumLikelihoodResult>& result,
                         const JudgeOptions& options) {
  std::vector<Pose> hand;
  std::vector<Pose> eye;
  for (const HandEyeObservation& observation : observations) {
    if (!are_usable({&observation.poses, 1})) continue;
    hand.push_back(observation.poses.room_from_hand);
    eye.push_back(observation.poses.eye_from_scene.inverse());
  }
  const ScaleMode scale = options.solver.estimate_scale ? ScaleMode::kUnknown : ScaleMode::kKnown;
  const MotionFacts eye_facts = motion_facts(eye);
  const MotionProblem problem =
      classify(motion_facts(hand), &eye_facts, options.solver.noise, false, scale);
  if (problem != MotionProblem::kFixedPoint && problem != MotionProblem::kNone) return problem;
  // The sigma of the scale decides whether a pivot is to blame, not how the motion looks.
  const bool pivot =
      result ? scale_is_to_blame(*result, options) : problem == MotionProblem::kFixedPoint;
  return pivot ? MotionProblem::kFixedPoint : MotionProblem::kUncertain;
}

}  // namespace

Judgement judge(std::span<const HandEyeObservation> observations,
                const std::optional<MaximumLikelihoodResult>& result, const JudgeOptions& options) {
  Judgement judgement;
  if (result) weigh(observations, *result, options, judgement);
  const bool enough = result && result->poses_used >= kMinPoses;
  if (enough) {
    const bool two_halves = judgement.halves_chi2.has_value() || result->poses_used < 2 * kMinHalf;
    if (two_halves && suffices(judgement.covariance, *result, options)) {
      judgement.problem = MotionProblem::kNone;
      return judgement;
    }
  }
  // Precise by itself: the motion was enough, and the halves disagree.
  const bool uncertain = enough && suffices(result->covariance, *result, options);
  judgement.problem =
      uncertain ? MotionProblem::kUncertain : problem_of(observations, result, options);
  if (result) {
    judgement.missing =
        missing_motion(observations, result->solution.hand_from_eye, judgement.observability,
                       judgement.problem == MotionProblem::kFixedPoint);
  }
  return judgement;
}

MotionProblem classify_hand_motion(std::span<const Pose> room_from_hand, const PoseNoise& noise,
                                   bool images_without_parallax) {
  return classify(motion_facts(room_from_hand), nullptr, noise, images_without_parallax,
                  ScaleMode::kUnknown);
}

}  // namespace handeye
