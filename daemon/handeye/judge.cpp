// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/judge.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include "daemon/handeye/motion_facts.hpp"

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
                       bool images_without_parallax) {
  const Eigen::Vector3d& turn = hand.principal_rotation_rad;
  const double noise_turn = kAboveNoise * noise.hand_rotation_rad;
  const bool turns = turn.norm() > std::max(noise_turn, rad_from_deg(kStillRotation_deg));
  const bool moves =
      hand.path_rms > std::max(kAboveNoise * noise.hand_translation_mm, kStillPath_mm);
  if (!turns && !moves) return MotionProblem::kNoMotion;
  if (turn[0] < std::max(noise_turn, rad_from_deg(kMinRotation_deg))) {
    return MotionProblem::kInsufficientRotation;
  }
  if (images_without_parallax || (eye && turns_about_camera(hand, *eye, noise))) {
    return MotionProblem::kNoParallax;
  }
  if (turn[1] < std::max(noise_turn, kMinSecondAxis * turn[0])) return MotionProblem::kSingleAxis;
  if (pivots(hand, noise)) return MotionProblem::kFixedPoint;
  return MotionProblem::kNone;
}

/// Whether the unknown scale is what makes the translation uncertain.
bool scale_is_to_blame(const MaximumLikelihoodResult& result, const JudgeOptions& options) {
  const double sigma = result.sigma_translation_mm();
  const double known = result.sigma_translation_known_scale_mm;
  return result.log_scale_sigma > options.max_log_scale_sigma ||
         (sigma > options.wanted_translation_mm &&
          known * known < (1.0 - kScaleShare) * sigma * sigma);
}

struct HalvesComparison {
  Vector6d difference;  ///< (w [rad], dt [mm]) from the second half's answer to the first's
  double chi2{0};
};

std::optional<HalvesComparison> compare_halves(std::span<const HandEyeObservation> observations,
                                               const HandEyeSolution& start,
                                               const JudgeOptions& options) {
  const std::size_t half = observations.size() / 2;
  if (half < kMinHalf) return std::nullopt;
  const auto first = maximum_likelihood(observations.first(half), start, options.solver);
  const auto second = maximum_likelihood(observations.subspan(half), start, options.solver);
  if (!first || !second) return std::nullopt;
  HalvesComparison comparison;
  comparison.difference << log_so3(first->solution.hand_from_eye.linear() *
                                   second->solution.hand_from_eye.linear().transpose()),
      first->solution.hand_from_eye.translation() - second->solution.hand_from_eye.translation();
  const Matrix6d covariance = first->covariance + second->covariance;
  comparison.chi2 = comparison.difference.dot(covariance.ldlt().solve(comparison.difference));
  return comparison;
}

/// What the answer is worth, and whether that is enough.
bool suffices(std::span<const HandEyeObservation> observations,
              const MaximumLikelihoodResult& result, const JudgeOptions& options,
              Judgement& judgement) {
  judgement.covariance = result.covariance;
  const auto halves = compare_halves(observations, result.solution, options);
  if (!halves) return false;
  judgement.halves_chi2 = halves->chi2;
  if (halves->chi2 > options.halves_chi2_by_chance) {
    judgement.covariance += 0.25 * halves->difference * halves->difference.transpose();
  }
  return sigma_rotation_deg(judgement.covariance) <= options.wanted_rotation_deg &&
         sigma_translation_mm(judgement.covariance) <= options.wanted_translation_mm &&
         result.log_scale_sigma <= options.max_log_scale_sigma;
}

}  // namespace

Judgement judge(std::span<const HandEyeObservation> observations,
                const std::optional<MaximumLikelihoodResult>& result, const JudgeOptions& options) {
  Judgement judgement;
  if (result && suffices(observations, *result, options, judgement)) {
    judgement.problem = MotionProblem::kNone;
    return judgement;
  }
  const bool precise_by_itself = result &&
                                 result->sigma_rotation_deg() <= options.wanted_rotation_deg &&
                                 result->sigma_translation_mm() <= options.wanted_translation_mm &&
                                 result->log_scale_sigma <= options.max_log_scale_sigma;
  if (precise_by_itself) return judgement;  // the motion was enough: uncertain

  std::vector<Pose> hand;
  std::vector<Pose> eye;
  for (const HandEyeObservation& observation : observations) {
    hand.push_back(observation.poses.room_from_hand);
    eye.push_back(observation.poses.eye_from_scene.inverse());
  }
  const MotionFacts eye_facts = motion_facts(eye);
  judgement.problem = classify(motion_facts(hand), &eye_facts, options.solver.noise, false);
  if (judgement.problem == MotionProblem::kFixedPoint ||
      judgement.problem == MotionProblem::kNone) {
    // The sigma of the scale decides whether a pivot is to blame, not how the motion looks.
    const bool pivot = result ? scale_is_to_blame(*result, options)
                              : judgement.problem == MotionProblem::kFixedPoint;
    judgement.problem = pivot ? MotionProblem::kFixedPoint : MotionProblem::kUncertain;
  }
  return judgement;
}

MotionProblem classify_hand_motion(std::span<const Pose> room_from_hand, const PoseNoise& noise,
                                   bool images_without_parallax) {
  return classify(motion_facts(room_from_hand), nullptr, noise, images_without_parallax);
}

}  // namespace handeye
