// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/handeye/one_step_degenerate.hpp"

#include <algorithm>

namespace handeye::synthetic {
namespace {

const Eigen::Vector3d kTurn_deg(20, 20, 20);
const Eigen::Vector3d kSlide_mm(15, 15, 15);

PoseNoise tracker_noise(const OneStepScene& scene) {
  PoseNoise noise;
  noise.hand_rotation_rad = scene.options.hand_rotation_sigma_rad;
  noise.hand_translation_mm = scene.options.hand_translation_sigma_mm;
  return noise;
}

/// No reconstruction stands on less.
bool has_structure(const OneStepProblem& problem) {
  const bool posed = std::ranges::all_of(problem.frames, [](const OneStepFrame& frame) {
    return frame.eye_from_scene.matrix().allFinite();
  });
  return posed && problem.points.size() > 30;
}

Verdict by_hand_alone(const OneStepScene& scene) {
  std::vector<Pose> hand;
  for (const OneStepFrame& frame : scene.problem.frames) {
    if (frame.hand) hand.push_back(frame.hand->room_from_hand);
  }
  Verdict verdict;
  verdict.judgement.problem = classify_hand_motion(hand, tracker_noise(scene), true);
  verdict.judgement.missing = remedy(verdict.judgement.problem);
  return verdict;
}

Verdict weighed(const Judgement& judgement, const Pose& hand_from_eye, const OneStepScene& scene) {
  const Vector6d error = error_of(hand_from_eye, scene.hand_from_eye);
  return {judgement,
          deg_from_rad(error.head<3>().norm()) / sigma_rotation_deg(judgement.covariance),
          error.tail<3>().norm() / sigma_translation_mm(judgement.covariance)};
}

}  // namespace

const std::vector<Degenerate>& degenerate_motions() {
  static const std::vector<Degenerate> kMotions{
      {"PureTranslation",
       [](double a) {
         return MotionShape{a * kTurn_deg, kSlide_mm};
       },
       MotionProblem::kInsufficientRotation, MissingMotion::kTiltUpAndDown},
      {"OneAxis",
       [](double a) {
         return MotionShape{Eigen::Vector3d(20, 20 * a, 20 * a), kSlide_mm};
       },
       MotionProblem::kSingleAxis, MissingMotion::kTurnLeftAndRight},
      {"Pivot",
       [](double a) {
         return MotionShape{kTurn_deg, a * kSlide_mm, kTrocar_mm};
       },
       MotionProblem::kFixedPoint, MissingMotion::kSlideInAndOut},
      {"AboutCameraCentre",
       [](double a) {
         return MotionShape{kTurn_deg, a * kSlide_mm, Eigen::Vector3d::Zero()};
       },
       MotionProblem::kNoParallax, MissingMotion::kSlideSideways},
      {"NoMotion",
       [](double a) {
         return MotionShape{a * kTurn_deg, a * kSlide_mm};
       },
       MotionProblem::kNoMotion, MissingMotion::kTiltUpAndDown},
      {"WobbleBelowTheNoise",
       [](double a) {
         return MotionShape{std::max(a, 0.003) * kTurn_deg, std::max(a, 0.005) * kSlide_mm};
       },
       MotionProblem::kNoMotion, MissingMotion::kTiltUpAndDown},
  };
  return kMotions;
}

Verdicts verdicts(const OneStepSceneOptions& options, std::uint32_t seed,
                  const JudgeOptions& wanted) {
  const OneStepScene scene = one_step_scene(options, seed);
  if (!has_structure(scene.problem)) {
    const Verdict verdict = by_hand_alone(scene);
    return {verdict, verdict};
  }
  const std::vector<HandEyeObservation> observations = observations_of(scene.problem);
  const auto start = start_of(scene);
  JudgeOptions judging = wanted;
  judging.solver.noise = tracker_noise(scene);
  judging.solver.estimate_time_offset = true;
  const Judgement of_start = judge(observations, start, judging);
  if (!start) return {{of_start}, {of_start}};
  Verdicts result;
  result.likelihood = weighed(of_start, start->solution.hand_from_eye, scene);
  const OneStepOptions solving = one_step_options(scene, HandNoiseSource::kEstimated);
  const auto found = one_step(scene.problem, *start, solving);
  if (!found) {
    result.one_step = result.likelihood;
    return result;
  }
  const JudgedAnswer answer{found->hand_from_eye, found->covariance,
                            compare_halves(scene.problem, *start, *found, solving),
                            found->log_scale_sigma};
  result.one_step =
      weighed(judge(observations, *start, answer, judging), found->hand_from_eye, scene);
  return result;
}

Verdicts verdicts(const Degenerate& motion, double amplitude, std::uint32_t seed, int frames) {
  OneStepSceneOptions options;
  options.tracks.frames = frames;
  options.tracks.motion = shaped_motion(motion.shape(amplitude));
  return verdicts(options, seed);
}

}  // namespace handeye::synthetic
