// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/judge.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/Dense>

#include "daemon/handeye/parts.hpp"

namespace handeye {
namespace {

constexpr double kScaleShare = 0.5;        // of the translation's variance that is the scale's
constexpr std::size_t kMinHalf = 5;        // poses
constexpr std::size_t kMinPoses = 5;       // fewer hardly contradict any answer
constexpr double kMaxContradicting = 0.2;  // share of the poses, in parts that were left out

ScaleMode scale_of(const JudgeOptions& options) {
  return options.solver.estimate_scale ? ScaleMode::kUnknown : ScaleMode::kKnown;
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

/// An answer, and the halves that speak of it: its own, or another answer's to the same data.
struct Weighed {
  const JudgedAnswer& answer;
  std::optional<HalvesComparison> of_another{};

  /// Nothing: there are none.
  const HalvesComparison* halves() const {
    if (answer.halves) return &*answer.halves;
    return of_another ? &*of_another : nullptr;
  }
  bool agrees(const JudgeOptions& options) const {
    return answer.halves && answer.halves->chi2 <= options.halves_chi2_by_chance;
  }
  /// Of the answer, where its halves differ by more than chance.
  Vector6d error() const {
    return answer.halves ? answer.halves->error_of_whole() : Vector6d(0.5 * of_another->difference);
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
  if (const HalvesComparison* halves = weighed.halves()) {
    judgement.halves_chi2 = halves->chi2;
    if (halves->chi2 > options.halves_chi2_by_chance) {
      const Vector6d error = weighed.error();
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
  const bool two_halves = weighed.halves() != nullptr || result.poses_used < 2 * kMinHalf;
  if (enough && two_halves && suffices(judgement.covariance, result, weighed, options)) {
    judgement.problem = MotionProblem::kNone;
    return judgement;
  }
  // Precise by itself: the motion was enough, and the halves disagree.
  const JudgedAnswer& answer = weighed.answer;
  const bool uncertain = enough && suffices(answer.covariance, result, weighed, options);
  judgement.problem = uncertain
                          ? MotionProblem::kUncertain
                          : motion_problem(observations, options.solver.noise, scale_of(options),
                                           scale_is_to_blame(result, weighed, options));
  judgement.missing = missing_motion(observations, answer, judgement.problem, options);
  return judgement;
}

/// Nothing when a half is too short.
std::optional<HalvesOfWhole> halves_of(std::span<const HandEyeObservation> observations,
                                       const MaximumLikelihoodResult& result,
                                       const JudgeOptions& options) {
  if (result.poses_used < 2 * kMinHalf) return std::nullopt;
  return compare_halves(observations, result, options.solver);
}

}  // namespace

Judgement judge(std::span<const HandEyeObservation> observations,
                const MaximumLikelihoodResult& result, const JudgedAnswer& answer,
                const JudgeOptions& options) {
  if (!answer.halves) {
    return judge(observations, result, Weighed{answer, halves_of(observations, result, options)},
                 options);
  }
  if (answer.covariance.allFinite() && answer.halves->of_whole != answer.covariance) {
    throw std::invalid_argument("an answer is judged by halves of its own only");
  }
  return judge(observations, result, Weighed{answer}, options);
}

Judgement judge(std::span<const HandEyeObservation> observations,
                const std::optional<MaximumLikelihoodResult>& result, const JudgeOptions& options) {
  if (result) {
    const JudgedAnswer answer{.hand_from_eye = result->solution.hand_from_eye,
                              .covariance = result->covariance,
                              .halves = halves_of(observations, *result, options),
                              .log_scale_sigma = {}};
    return judge(observations, *result, Weighed{answer}, options);
  }
  Judgement judgement;
  judgement.problem = motion_problem(observations, options.solver.noise, scale_of(options));
  judgement.missing = remedy(judgement.problem);
  return judgement;
}

}  // namespace handeye
