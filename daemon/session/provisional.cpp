// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/provisional.hpp"

#include <algorithm>

#include "daemon/handeye/motion_facts.hpp"
#include "daemon/session/estimate.hpp"
#include "daemon/session/lens_sensitivity.hpp"
#include "daemon/session/method_comparison.hpp"

namespace handeye {
namespace {

// The covariance is linearised: beyond this it means nothing, and the answer may be anywhere.
constexpr double kMeaningful_deg = 5;
constexpr double kHalvesDegrees = 6;  // of freedom, of halves_chi2

/// Whether there is an answer at all in this motion, if only a rough one. In the first seconds
/// there is none for want of a time offset: at a wrong one it looks better than it is.
bool is_answer(const Estimate& so_far, const Judgement& judgement) {
  if (!so_far.has_time_offset()) return false;
  const bool turned_enough = judgement.problem == MotionProblem::kNone ||
                             judgement.problem == MotionProblem::kUncertain ||
                             judgement.problem == MotionProblem::kFixedPoint;
  return turned_enough && judgement.halves_chi2.has_value() && judgement.covariance.allFinite() &&
         sigma_rotation_deg(judgement.covariance) <= kMeaningful_deg;
}

JudgeOptions judge_options(const ProvisionalSnapshot& snapshot, const Estimate& so_far) {
  JudgeOptions options;
  options.wanted_rotation_deg = snapshot.wanted.rotation_deg;
  options.wanted_translation_mm = snapshot.wanted.translation_mm;
  options.solver = so_far.options;
  return options;
}

Eigen::Vector3d turns_of(const Estimate& so_far) {
  std::vector<Pose> room_from_hand;
  room_from_hand.reserve(so_far.observations.size());
  for (const HandEyeObservation& observation : so_far.observations) {
    room_from_hand.push_back(observation.poses.room_from_hand);
  }
  return turned_deg(room_from_hand, so_far.likelihood->solution.hand_from_eye);
}

void write_time_offset(const Estimate& so_far, Provisional& answer) {
  if (!so_far.correlation) return;
  answer.time_offset_s = so_far.time_offset_s;
  answer.time_offset_sigma_s = so_far.time_offset_sigma_s;
  answer.time_offset_confidence = so_far.correlation->confidence;
}

/// By how much the covariance claims too little for what the eye's poses have in common: few points
/// place them all. The halves tell, by Birge's ratio; where they differ by more than chance, their
/// difference is in the judgement's covariance already.
double widening(const Judgement& judgement) {
  if (*judgement.halves_chi2 > JudgeOptions{}.halves_chi2_by_chance) return 1;
  return std::max(1.0, *judgement.halves_chi2 / kHalvesDegrees);
}

void write_sigma(const ProvisionalSnapshot& snapshot, const Estimate& so_far,
                 const Judgement& judgement, Provisional& answer) {
  if (!snapshot.lens_given && hand_contradicts_lens(so_far.observations)) return;
  answer.sigma_beside_lens = sigma_of(judgement.covariance);
  if (!snapshot.lens_covariance) return;
  answer.sigma = sigma_of(widening(judgement) * judgement.covariance + *snapshot.lens_covariance);
}

}  // namespace

Provisional provisional(const ProvisionalSnapshot& snapshot) {
  Provisional answer;
  const Estimate so_far = estimate(snapshot.frames, snapshot.hand, snapshot.noise, snapshot.scale);
  answer.frames = static_cast<std::int64_t>(so_far.observations.size());
  write_time_offset(so_far, answer);
  if (!so_far.likelihood) return answer;
  const Judgement judgement =
      judge(so_far.observations, so_far.likelihood, judge_options(snapshot, so_far));
  answer.missing = judgement.missing;
  if (!is_answer(so_far, judgement)) return answer;
  answer.solution = so_far.likelihood->solution;
  answer.turned_deg = turns_of(so_far);
  write_sigma(snapshot, so_far, judgement, answer);
  return answer;
}

}  // namespace handeye
