// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/judge.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/unit/handeye/synthetic.hpp"

namespace handeye {

void PrintTo(MotionProblem problem, std::ostream* out) {
  constexpr const char* kNames[] = {"none",        "no_motion",   "insufficient_rotation",
                                    "no_parallax", "single_axis", "fixed_point",
                                    "uncertain"};
  *out << kNames[static_cast<int>(problem)];
}

namespace {

using synthetic::record;
using synthetic::Recording;
using synthetic::scope;
using synthetic::tracker_and_camera;

Judgement judged(const std::vector<HandEyeObservation>& observations) {
  return judge(observations, maximum_likelihood(observations));
}

MotionProblem problem_of(const synthetic::Motion& motion, std::uint32_t seed) {
  return judged(record(scope(0.07), motion, 300, tracker_and_camera(), seed).observations).problem;
}

TEST(Judge, AcceptsAFreeHand) {
  for (std::uint32_t seed = 0; seed < 5; ++seed) {
    const Judgement judgement = judged(
        record(scope(0.07), synthetic::free_hand, 300, tracker_and_camera(), seed).observations);
    EXPECT_EQ(judgement.problem, MotionProblem::kNone) << seed;
    ASSERT_TRUE(judgement.halves_chi2);
    EXPECT_LT(*judgement.halves_chi2, 27.9) << "exceeded by chance once in 10 000";
  }
}

/// However many were recorded: what was left out says nothing for the answer.
TEST(Judge, CountsThePosesThatWereUsed) {
  const auto observations =
      record(scope(0.07), synthetic::free_hand, 300, tracker_and_camera(), 1).observations;
  auto result = maximum_likelihood(observations);
  ASSERT_TRUE(result);
  EXPECT_EQ(judge(observations, result).problem, MotionProblem::kNone);
  result->poses_used = 4;
  EXPECT_NE(judge(observations, result).problem, MotionProblem::kNone);
}

TEST(Judge, NamesWhatTheMotionLacks) {
  for (std::uint32_t seed = 0; seed < 3; ++seed) {
    EXPECT_EQ(problem_of(synthetic::still, seed), MotionProblem::kNoMotion);
    EXPECT_EQ(problem_of(synthetic::translation_only, seed), MotionProblem::kInsufficientRotation);
    EXPECT_EQ(problem_of(synthetic::about_camera_centre, seed), MotionProblem::kNoParallax);
    EXPECT_EQ(problem_of(synthetic::one_axis, seed), MotionProblem::kSingleAxis);
    EXPECT_EQ(problem_of(synthetic::pivot, seed), MotionProblem::kFixedPoint);
  }
}

TEST(Judge, RefusesWhatIsTooUncertain) {
  const Recording recording = record(scope(), synthetic::free_hand, 300, tracker_and_camera(), 1);
  JudgeOptions options;
  options.wanted_rotation_deg = 0.001;
  options.wanted_translation_mm = 10;
  const auto result = maximum_likelihood(recording.observations);
  EXPECT_EQ(judge(recording.observations, result, options).problem, MotionProblem::kUncertain);
}

/// The camera turns in its clip half-way: a small residual on either half, but not the same answer.
std::vector<HandEyeObservation> after_slip_of(double slip_deg) {
  Recording recording = record(scope(), synthetic::free_hand, 400, tracker_and_camera(), 2);
  Pose slip = Pose::Identity();
  slip.linear() = exp_so3({0, 0, rad_from_deg(slip_deg)});
  for (std::size_t k = 200; k < recording.observations.size(); ++k) {
    Pose& eye = recording.observations[k].poses.eye_from_scene;
    eye = slip * eye;
  }
  return recording.observations;
}

Judgement judged_after_slip_of(double slip_deg) {
  return judged(after_slip_of(slip_deg));
}

/// An answer of another method that claims to be a hundred times as certain as the likelihood's.
Judgement judged_boaster_after_slip_of(double slip_deg) {
  const auto observations = after_slip_of(slip_deg);
  const auto result = maximum_likelihood(observations);
  if (!result) return {};
  const JudgedAnswer answer{.hand_from_eye = result->solution.hand_from_eye,
                            .covariance = 1e-4 * result->covariance,
                            .halves = {},
                            .log_scale_sigma = 1e-2 * result->log_scale_sigma};
  return judge(observations, *result, answer);
}

TEST(Judge, RefusesWhenTheHalvesDisagree) {
  const Judgement judgement = judged_after_slip_of(1.0);
  ASSERT_TRUE(judgement.halves_chi2);
  EXPECT_GT(*judgement.halves_chi2, 27.9);
  EXPECT_EQ(judgement.problem, MotionProblem::kUncertain);
}

TEST(Judge, TakesHalfOfTheHalvesDisagreementAsAnError) {
  const Judgement judgement = judged_after_slip_of(0.3);
  EXPECT_GT(*judgement.halves_chi2, 27.9);
  EXPECT_EQ(judgement.problem, MotionProblem::kNone) << "0.15 deg where 0.3 were wanted";
  EXPECT_GE(sigma_rotation_deg(judgement.covariance), 0.14) << "never less than half the slip";
}

/// Were its claim to weigh the likelihood's halves, it would silence them.
TEST(Judge, LetsNoAnswerSilenceTheHalvesOfAnother) {
  const Judgement judgement = judged_boaster_after_slip_of(1.0);
  EXPECT_EQ(judgement.problem, MotionProblem::kUncertain);
  EXPECT_GE(sigma_rotation_deg(judgement.covariance), 0.45) << "half the slip";
  EXPECT_EQ(judged_boaster_after_slip_of(0).problem, MotionProblem::kNone);
}

TEST(Judge, WeighsNoAnswerByTheHalvesOfAnother) {
  const auto observations = after_slip_of(0);
  const auto result = maximum_likelihood(observations);
  ASSERT_TRUE(result);
  JudgedAnswer answer{.hand_from_eye = result->solution.hand_from_eye,
                      .covariance = result->covariance,
                      .halves = compare_halves(observations, *result, {}),
                      .log_scale_sigma = {}};
  EXPECT_NO_THROW(judge(observations, *result, answer));
  answer.covariance *= 1e-4;
  EXPECT_THROW(judge(observations, *result, answer), std::invalid_argument);
}

TEST(Judge, BelievesItsOwnWordOfTheScaleWhereItsHalvesAgree) {
  const auto observations =
      record(scope(), synthetic::free_hand, 300, tracker_and_camera(), 1).observations;
  auto result = maximum_likelihood(observations);
  ASSERT_TRUE(result);
  result->log_scale_sigma = 0.5;
  for (PartResult& part : result->parts) part.log_scale_sigma = 0.5;
  JudgedAnswer answer{.hand_from_eye = result->solution.hand_from_eye,
                      .covariance = result->covariance,
                      .halves = compare_halves(observations, *result, {}),
                      .log_scale_sigma = 0.01};
  ASSERT_TRUE(answer.halves);
  ASSERT_LT(answer.halves->chi2, JudgeOptions{}.halves_chi2_by_chance);
  EXPECT_EQ(judge(observations, *result, answer).problem, MotionProblem::kNone);
  answer.halves->difference *= 100;
  answer.halves->chi2 *= 1e4;
  EXPECT_NE(judge(observations, *result, answer).problem, MotionProblem::kNone);
  answer.halves.reset();
  EXPECT_NE(judge(observations, *result, answer).problem, MotionProblem::kNone);
}

TEST(Judge, NamesTheMotionOfTheHandAlone) {
  const auto classified = [](const synthetic::Motion& motion, bool no_parallax = false) {
    std::vector<Pose> hand;
    for (const auto& o : record(scope(), motion, 300, tracker_and_camera(), 3).observations) {
      hand.push_back(o.poses.room_from_hand);
    }
    return classify_hand_motion(hand, tracker_and_camera(), no_parallax);
  };
  EXPECT_EQ(classified(synthetic::still), MotionProblem::kNoMotion);
  EXPECT_EQ(classified(synthetic::still, true), MotionProblem::kNoMotion);
  EXPECT_EQ(classified(synthetic::translation_only), MotionProblem::kInsufficientRotation);
  EXPECT_EQ(classified(synthetic::about_camera_centre, true), MotionProblem::kNoParallax);
  EXPECT_EQ(classified(synthetic::one_axis), MotionProblem::kSingleAxis);
  EXPECT_EQ(classified(synthetic::pivot), MotionProblem::kFixedPoint);
  EXPECT_EQ(classified(synthetic::free_hand), MotionProblem::kNone);
  EXPECT_EQ(classify_hand_motion({}, tracker_and_camera()), MotionProblem::kNoMotion);
}

TEST(Judge, RefusesTheRealLaparoscopeAsAFixedPoint) {
  const auto poses = synthetic::real_poses("laparoscope.csv");
  if (poses.empty()) GTEST_SKIP() << "no poses/laparoscope.csv";
  std::vector<HandEyeObservation> observations;
  for (const PosePair& pair : poses) observations.push_back({pair, {0, 0, 0}, {0, 0, 0}});
  const auto result = maximum_likelihood(observations);
  ASSERT_TRUE(result);
  EXPECT_EQ(judge(observations, result).problem, MotionProblem::kFixedPoint);
  // A refused result still carries its estimate: it must be within reason.
  EXPECT_GT(result->solution.scale_units_per_mm, 1e-2);
  EXPECT_LT(result->solution.scale_units_per_mm, 1e2);
}

}  // namespace
}  // namespace handeye
