// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <gtest/gtest.h>

#include "daemon/handeye/one_step/one_step.hpp"
#include "tests/unit/handeye/one_step_motions.hpp"
#include "tests/unit/handeye/one_step_scenes.hpp"

/// What the joint adjustment finds.
namespace handeye {
namespace {

using synthetic::one_step_options;
using synthetic::one_step_scene;
using synthetic::OneStepScene;
using synthetic::OneStepSceneOptions;
using synthetic::start_of;

struct Solved {
  OneStepScene scene;
  MaximumLikelihoodResult start;
  OneStepResult result;
  Vector6d error;
};

std::optional<Solved> solve(const OneStepSceneOptions& options, std::uint32_t seed,
                            HandNoiseSource source = HandNoiseSource::kEstimated) {
  OneStepScene scene = one_step_scene(options, seed);
  const auto start = start_of(scene);
  if (!start) return std::nullopt;
  const auto result = one_step(scene.problem, *start, one_step_options(scene, source));
  if (!result) return std::nullopt;
  const Vector6d error = synthetic::error_of(result->hand_from_eye, scene.hand_from_eye);
  return Solved{std::move(scene), *start, *result, error};
}

TEST(OneStepSolver, IsNearerThanItsStart) {
  double start_squares = 0;
  double squares = 0;
  for (std::uint32_t seed = 0; seed < 8; ++seed) {
    const auto solved = solve({}, seed);
    ASSERT_TRUE(solved);
    const Vector6d before =
        synthetic::error_of(solved->start.solution.hand_from_eye, solved->scene.hand_from_eye);
    start_squares += before.tail<3>().squaredNorm();
    squares += solved->error.tail<3>().squaredNorm();
  }
  EXPECT_LT(squares, 0.5 * start_squares);
}

TEST(OneStepSolver, FindsTheTimeOffset) {
  for (const double offset_s : {-0.02, 0.0, 0.02}) {
    OneStepSceneOptions options;
    options.time_offset_error_s = offset_s;
    const auto solved = solve(options, 3);
    ASSERT_TRUE(solved);
    EXPECT_NEAR(solved->result.time_offset_correction_s, solved->scene.time_offset_error_s, 0.6e-3);
    EXPECT_NEAR(solved->result.time_offset_correction_s, solved->scene.time_offset_error_s,
                3.5 * solved->result.time_offset_sigma_s);
  }
}

TEST(OneStepSolver, HoldsATimeOffsetThatIsNotEstimated) {
  OneStepScene scene = one_step_scene({}, 4);
  OneStepOptions options = one_step_options(scene, HandNoiseSource::kEstimated);
  options.estimate_time_offset = false;
  const auto result = one_step(scene.problem, *start_of(scene), options);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->time_offset_correction_s, 0.0);
  EXPECT_EQ(result->time_offset_sigma_s, 0.0);
}

void expect_noise_is_found(const OneStepSceneOptions& options) {
  double image = 0;
  double rotation = 0;
  double translation = 0;
  constexpr int kSeeds = 8;
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    const auto solved = solve(options, seed);
    ASSERT_TRUE(solved);
    image += solved->result.image_noise_px / kSeeds;
    rotation += solved->result.hand_rotation_sigma_rad / kSeeds;
    translation += solved->result.hand_translation_sigma_mm / kSeeds;
  }
  EXPECT_NEAR(image / options.tracks.noise_px, 1.0, 0.06);
  EXPECT_NEAR(rotation / options.hand_rotation_sigma_rad, 1.0, 0.1);
  EXPECT_NEAR(translation / options.hand_translation_sigma_mm, 1.0, 0.15);
}

TEST(OneStepSolver, EstimatesTheNoise) {
  OneStepSceneOptions options;
  options.keyframe_interval = 1;
  expect_noise_is_found(options);
}

TEST(OneStepSolver, EstimatesTheNoiseWhereFramesFollowKeyframes) {
  expect_noise_is_found({});
}

/// Images are never trusted beyond what features err by together; what they show is told as it is,
/// and the tracker's noise does not suffer.
TEST(OneStepSolver, EstimatesTheNoiseOfImagesThatHaveHardlyAny) {
  OneStepSceneOptions options;
  options.tracks.noise_px = 0.05;
  expect_noise_is_found(options);
}

TEST(OneStepSolver, FindsTheLens) {
  OneStepSceneOptions options;
  options.lens = IntrinsicsMode::kRefine;
  const auto solved = solve(options, 5);
  ASSERT_TRUE(solved);
  const LensVector off =
      lens_vector(solved->result.camera) - lens_vector(solved->scene.tracks.camera);
  const LensVector sigma = solved->result.lens_covariance.diagonal().cwiseSqrt();
  EXPECT_LT(sigma[kFocal], 0.2 * solved->scene.lens_prior->sigma[kFocal]);
  for (int i = 0; i < kLensParameters; ++i) EXPECT_LT(std::abs(off[i]), 4.0 * sigma[i]) << i;
}

TEST(OneStepSolver, PlacesEveryFrameInTheRoom) {
  const auto solved = solve({}, 6);
  ASSERT_TRUE(solved);
  ASSERT_EQ(solved->result.eye_from_room.size(), solved->scene.problem.frames.size());
  for (std::size_t k = 0; k < solved->result.eye_from_room.size(); ++k) {
    ASSERT_TRUE(solved->result.eye_from_room[k]) << k;
    const Pose off =
        *solved->result.eye_from_room[k] * solved->scene.tracks.eye_from_room[k].inverse();
    EXPECT_LT(deg_from_rad(rotation_angle_rad(off.linear())), 1.0) << k;
  }
}

TEST(OneStepSolver, LeavesOutGrosslyWrongHands) {
  OneStepSceneOptions options;
  options.outlier_samples = 0.03;
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    const auto solved = solve(options, seed);
    ASSERT_TRUE(solved);
    EXPECT_FALSE(solved->result.rejected.empty());
    EXPECT_LT(solved->result.rejected.size(), 20U);
    EXPECT_LT(solved->error.tail<3>().norm(),
              3.5 * sigma_translation_mm(solved->result.covariance));
  }
}

TEST(OneStepSolver, JoinsParts) {
  OneStepSceneOptions options;
  options.tracks.frames = 200;
  options.tracks.parts = 2;
  const auto solved = solve(options, 7);
  ASSERT_TRUE(solved);
  EXPECT_LT(solved->error.tail<3>().norm(), 3.5 * sigma_translation_mm(solved->result.covariance));
  EXPECT_TRUE(solved->result.eye_from_room.front());
  EXPECT_TRUE(solved->result.eye_from_room.back());
}

TEST(OneStepSolver, TakesWhatTheTrackerSaysOfItsSamples) {
  OneStepSceneOptions options;
  options.hand_noise_varies = true;
  double measured = 0;
  double estimated = 0;
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    const auto by_samples = solve(options, seed, HandNoiseSource::kMeasured);
    const auto by_mean = solve(options, seed, HandNoiseSource::kEstimated);
    ASSERT_TRUE(by_samples && by_mean);
    measured += sigma_translation_mm(by_samples->result.covariance);
    estimated += sigma_translation_mm(by_mean->result.covariance);
  }
  EXPECT_LT(measured, estimated);
}

/// Near a fixed point, as through a trocar: what is claimed must be true (docs/math.md section 10).
TEST(OneStepSolver, IsHonestAboutATrocar) {
  for (const double slide_mm : {8.0, 2.0}) {
    OneStepSceneOptions options;
    options.keyframe_interval = 2;
    options.tracks.motion = synthetic::shaped_motion(
        {.slide_mm = {0, 0, slide_mm}, .centre_in_eye_mm = synthetic::kTrocar_mm});
    for (std::uint32_t seed = 0; seed < 6; ++seed) {
      const auto solved = solve(options, seed);
      ASSERT_TRUE(solved);
      EXPECT_LT(solved->error.tail<3>().norm(),
                3.5 * sigma_translation_mm(solved->result.covariance))
          << slide_mm << " mm, seed " << seed;
    }
  }
}

TEST(OneStepSolver, AnswersTheSameEveryTime) {
  const auto first = solve({}, 8);
  const auto second = solve({}, 8);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->result.hand_from_eye.matrix(), second->result.hand_from_eye.matrix());
  EXPECT_EQ(first->result.covariance, second->result.covariance);
}

}  // namespace
}  // namespace handeye
