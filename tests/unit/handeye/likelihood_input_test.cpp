// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "daemon/handeye/judge.hpp"
#include "tests/unit/handeye/synthetic.hpp"

/// Exact, few, rescaled and degenerate input.
namespace handeye {
namespace {

using synthetic::scope;
using synthetic::tracker_and_camera;

std::vector<HandEyeObservation> observed(const std::vector<PosePair>& poses) {
  std::vector<HandEyeObservation> observations;
  for (const PosePair& pair : poses) observations.push_back({.poses = pair});
  return observations;
}

MaximumLikelihoodOptions unordered(ScaleMode scale) {
  return {.account_for_correlation = false, .estimate_scale = scale == ScaleMode::kUnknown};
}

Judgement judged(const std::vector<HandEyeObservation>& observations, ScaleMode scale) {
  const MaximumLikelihoodOptions options = unordered(scale);
  return judge(observations, maximum_likelihood(observations, options), {.solver = options});
}

TEST(LikelihoodInput, OfThreeExactPosesIsEnough) {
  std::mt19937 generator(1);
  int solved = 0;
  for (int trial = 0; trial < 20; ++trial) {
    for (const ScaleMode scale : {ScaleMode::kKnown, ScaleMode::kUnknown}) {
      const auto truth = synthetic::random_truth(generator, scale == ScaleMode::kKnown ? 1 : 0.02);
      const auto poses = synthetic::random_poses(truth, generator, 3, rad_from_deg(120));
      const auto found = maximum_likelihood(observed(poses), unordered(scale));
      if (!found) continue;  // turns too alike
      ++solved;
      const Vector6d error =
          synthetic::error_of(found->solution.hand_from_eye, truth.solution.hand_from_eye);
      EXPECT_LT(error.head<3>().norm(), 1e-8) << trial;
      EXPECT_LT(error.tail<3>().norm(), 1e-4) << trial;
    }
  }
  EXPECT_GE(solved, 36);
}

TEST(LikelihoodInput, MayBeInAnyUnitOfTheScene) {
  const auto recording =
      synthetic::record(scope(), synthetic::free_hand, 100, tracker_and_camera(), 3);
  const auto one = maximum_likelihood(recording.observations);
  ASSERT_TRUE(one);
  const Eigen::Vector3d wanted = one->solution.hand_from_eye.translation();
  for (const double factor : {1e-6, 1e-3, 1e3, 1e6}) {
    auto scaled = recording.observations;
    for (auto& observation : scaled) observation.poses.eye_from_scene.translation() *= factor;
    const auto found = maximum_likelihood(scaled);
    ASSERT_TRUE(found);
    EXPECT_LT((found->solution.hand_from_eye.translation() - wanted).norm(), 1e-6 * wanted.norm());
    EXPECT_LT(rotation_angle_rad(found->solution.hand_from_eye.linear(),
                                 one->solution.hand_from_eye.linear()),
              1e-6);
    EXPECT_NEAR(found->solution.scale_units_per_mm / factor / one->solution.scale_units_per_mm, 1,
                1e-6);
    EXPECT_NEAR(found->sigma_translation_mm() / one->sigma_translation_mm(), 1, 1e-3);
  }
}

TEST(LikelihoodInput, ThatIsNoRotationGivesNothing) {
  auto observations =
      synthetic::record(scope(), synthetic::free_hand, 50, tracker_and_camera(), 4).observations;
  auto sheared = observations;
  sheared[7].poses.room_from_hand.linear()(0, 1) += 0.01;
  EXPECT_FALSE(maximum_likelihood(sheared));
  auto mirrored = observations;
  mirrored[7].poses.eye_from_scene.linear() *= -1;
  EXPECT_FALSE(maximum_likelihood(mirrored));
  auto infinite = observations;
  infinite[7].poses.room_from_hand.translation().z() = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(maximum_likelihood(infinite));
  for (const auto& bad : {sheared, mirrored, infinite}) {
    EXPECT_EQ(judged(bad, ScaleMode::kUnknown).problem, MotionProblem::kUncertain);
  }
}

/// What every problem is called, with noise and without.
TEST(LikelihoodInput, ThatIsDegenerateIsRefusedByItsName) {
  struct Case {
    const char* name;
    synthetic::Motion motion;
    MotionProblem known_scale;
    MotionProblem unknown_scale;
  };
  const Case cases[] = {
      {"still", synthetic::still, MotionProblem::kNoMotion, MotionProblem::kNoMotion},
      {"translation", synthetic::translation_only, MotionProblem::kInsufficientRotation,
       MotionProblem::kInsufficientRotation},
      {"one axis", synthetic::one_axis, MotionProblem::kSingleAxis, MotionProblem::kSingleAxis},
      {"pivot", synthetic::pivot, MotionProblem::kNone, MotionProblem::kFixedPoint},
      {"about the camera", synthetic::about_camera_centre, MotionProblem::kNone,
       MotionProblem::kNoParallax},
      {"free", synthetic::free_hand, MotionProblem::kNone, MotionProblem::kNone},
  };
  for (const PoseNoise& noise : {tracker_and_camera(), PoseNoise{0, 0, 0, 0}}) {
    for (const Case& c : cases) {
      const auto record = [&](double scale) {
        return synthetic::record(scope(scale), c.motion, 100, noise, 5).observations;
      };
      EXPECT_EQ(judged(record(1.0), ScaleMode::kKnown).problem, c.known_scale)
          << c.name << ", known scale, noise " << noise.hand_translation_mm;
      EXPECT_EQ(judged(record(0.3), ScaleMode::kUnknown).problem, c.unknown_scale)
          << c.name << ", unknown scale, noise " << noise.hand_translation_mm;
    }
  }
}

TEST(LikelihoodInput, OfOneOrTwoPosesIsRefused) {
  const auto all =
      synthetic::record(scope(), synthetic::free_hand, 80, tracker_and_camera(), 6).observations;
  EXPECT_EQ(judged({}, ScaleMode::kKnown).problem, MotionProblem::kNoMotion);
  EXPECT_EQ(judged({all[0]}, ScaleMode::kKnown).problem, MotionProblem::kNoMotion);
  EXPECT_NE(judged({all[0], all[40]}, ScaleMode::kKnown).problem, MotionProblem::kNone);
  EXPECT_NE(judged({all[0], all[20], all[40], all[60]}, ScaleMode::kKnown).problem,
            MotionProblem::kNone)
      << "four poses contradict nothing";
}

TEST(LikelihoodInput, ThatIsRefusedSaysWhatIsMissing) {
  // Tilting and sliding only: turning left and right, or rolling, would tell the rest.
  const auto tilting = [](double time_s) {
    Pose pose = synthetic::free_hand(time_s);
    const Eigen::Matrix3d attitude = synthetic::still(0).linear();
    const double tilt = log_so3(attitude.transpose() * pose.linear()).x();
    pose.linear() = attitude * exp_so3({tilt, 0, 0});
    return pose;
  };
  const auto observations =
      synthetic::record(scope(), tilting, 100, tracker_and_camera(), 7).observations;
  const Judgement judgement = judged(observations, ScaleMode::kKnown);
  EXPECT_EQ(judgement.problem, MotionProblem::kSingleAxis);
  EXPECT_TRUE(judgement.missing == MissingMotion::kTurnLeftAndRight ||
              judgement.missing == MissingMotion::kRoll);
  EXPECT_FALSE(words(judgement.missing).empty());
  const Eigen::Vector3d axis = scope().solution.hand_from_eye.linear().col(0);
  EXPECT_GT(std::abs(judgement.observability.rotation_deg.axis_in_hand.dot(axis)), 0.9);
}

}  // namespace
}  // namespace handeye
