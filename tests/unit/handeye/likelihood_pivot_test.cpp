// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <gtest/gtest.h>

#include "daemon/handeye/judge.hpp"
#include "tests/unit/handeye/synthetic.hpp"

/// About a fixed point, and nearly so (docs/math.md section 10): what is claimed must be true.
namespace handeye {
namespace {

using synthetic::record;
using synthetic::scope;
using synthetic::tracker_and_camera;

constexpr int kSeeds = 10;
constexpr int kPoses = 200;
constexpr double kHonest = 3.5;  // error in its own standard deviations

struct Outcome {
  double error_mm{0};
  MaximumLikelihoodResult result;
  Judgement judgement;
};

Outcome solve(const synthetic::Motion& motion, std::uint32_t seed,
              const MaximumLikelihoodOptions& options) {
  const synthetic::Truth truth = scope(options.estimate_scale ? 0.07 : 1.0);
  const auto recording = record(truth, motion, kPoses, tracker_and_camera(), seed);
  const auto found = maximum_likelihood(recording.observations, options);
  EXPECT_TRUE(found);
  if (!found) return {};
  const Vector6d error =
      synthetic::error_of(found->solution.hand_from_eye, truth.solution.hand_from_eye);
  return {error.tail<3>().norm(), *found,
          judge(recording.observations, found, {.solver = options})};
}

void expect_honest(const Outcome& outcome) {
  EXPECT_LT(outcome.error_mm, kHonest * sigma_translation_mm(outcome.judgement.covariance));
}

MaximumLikelihoodOptions noise_given() {
  return {.noise = tracker_and_camera(), .estimate_noise = false};
}

TEST(LikelihoodPivot, IsRefusedWithASigmaThatCoversTheError) {
  for (const auto& options : {MaximumLikelihoodOptions{}, noise_given()}) {
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
      const Outcome outcome = solve(synthetic::pivot, seed, options);
      expect_honest(outcome);
      EXPECT_EQ(outcome.judgement.problem, MotionProblem::kFixedPoint) << seed;
      EXPECT_EQ(outcome.judgement.missing, MissingMotion::kSlideInAndOut) << seed;
      EXPECT_GT(outcome.result.sigma_translation_mm(), 15.0) << seed;
    }
  }
}

TEST(LikelihoodPivot, IsHonestWhateverTheShift) {
  for (const double shift_mm : {0.3, 1.0, 2.0, 5.0}) {
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
      expect_honest(solve(synthetic::pivot_with_shift(shift_mm), seed, {}));
      expect_honest(solve(synthetic::pivot_with_shift(shift_mm), seed, noise_given()));
    }
  }
}

TEST(LikelihoodPivot, IsAcceptedWhereTheShiftIsEnough) {
  for (const double shift_mm : {3.0, 8.0, 15.0}) {
    for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
      const Outcome outcome = solve(synthetic::pivot_with_shift(shift_mm), seed, noise_given());
      EXPECT_EQ(outcome.judgement.problem, MotionProblem::kNone) << shift_mm << " seed " << seed;
      expect_honest(outcome);
    }
  }
}

/// How the translation noise is shared between hand and eye cannot be estimated: that costs.
TEST(LikelihoodPivot, IsAcceptedWithAnyNoiseWhereTheShiftIsLarge) {
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    const Outcome outcome = solve(synthetic::pivot_with_shift(8.0), seed, {});
    EXPECT_EQ(outcome.judgement.problem, MotionProblem::kNone) << seed;
    EXPECT_LT(outcome.error_mm, 1.5);
    expect_honest(outcome);
  }
}

TEST(LikelihoodPivot, IsNoProblemWithKnownScale) {
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    const Outcome outcome = solve(synthetic::pivot, seed, {.estimate_scale = false});
    EXPECT_EQ(outcome.judgement.problem, MotionProblem::kNone) << seed;
    EXPECT_LT(outcome.error_mm, 0.7) << seed;
    expect_honest(outcome);
  }
}

std::vector<HandEyeObservation> laparoscope() {
  std::vector<HandEyeObservation> observations;
  for (const PosePair& pair : synthetic::real_poses("laparoscope.csv")) {
    observations.push_back({.poses = pair});
  }
  return observations;
}

TEST(LikelihoodPivot, IsSeenInTheRealLaparoscope) {
  const auto observations = laparoscope();
  if (observations.empty()) GTEST_SKIP() << "no poses/laparoscope.csv";
  const MaximumLikelihoodOptions options{.account_for_correlation = false};
  const auto found = maximum_likelihood(observations, options);
  ASSERT_TRUE(found);
  const Judgement judgement = judge(observations, found, {.solver = options});
  EXPECT_EQ(judgement.problem, MotionProblem::kFixedPoint);
  const Eigen::Vector3d reference(-27.9, 3.4, -275.6);
  EXPECT_LT((found->solution.hand_from_eye.translation() - reference).norm(),
            kHonest * sigma_translation_mm(judgement.covariance));
}

TEST(LikelihoodPivot, OfTheRealLaparoscopeIsSolvedWithKnownScale) {
  const auto observations = laparoscope();
  if (observations.empty()) GTEST_SKIP() << "no poses/laparoscope.csv";
  const MaximumLikelihoodOptions options{.account_for_correlation = false, .estimate_scale = false};
  const auto found = maximum_likelihood(observations, options);
  ASSERT_TRUE(found);
  // The README's t is PARK's, and these poses are uncertain to millimetres.
  const Eigen::Vector3d reference(-27.9, 3.4, -275.6);
  EXPECT_LT((found->solution.hand_from_eye.translation() - reference).norm(),
            kHonest * found->sigma_translation_mm());
  EXPECT_LT((found->solution.hand_from_eye.translation() - reference).norm(), 5.0);
  EXPECT_NE(judge(observations, found, {.solver = options}).problem, MotionProblem::kFixedPoint);
}

}  // namespace
}  // namespace handeye
