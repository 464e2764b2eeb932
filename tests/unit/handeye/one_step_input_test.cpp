// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/handeye/one_step/metric_scene.hpp"
#include "tests/unit/handeye/one_step_scenes.hpp"

/// What the joint adjustment makes of input that is incomplete or none.
namespace handeye {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class OneStepInput : public ::testing::Test {
 protected:
  std::optional<OneStepResult> solve() const {
    return one_step(scene_.problem, start_,
                    synthetic::one_step_options(scene_, HandNoiseSource::kEstimated));
  }
  double error_in_sigmas(const OneStepResult& result) const {
    return synthetic::error_of(result.hand_from_eye, scene_.hand_from_eye).tail<3>().norm() /
           sigma_translation_mm(result.covariance);
  }

  synthetic::OneStepScene scene_ = synthetic::one_step_scene({}, 1);
  MaximumLikelihoodResult start_ = *synthetic::start_of(scene_);
};

TEST_F(OneStepInput, ThatIsNoNumberHasNoAnswer) {
  const OneStepProblem sound = scene_.problem;
  scene_.problem.frames[7].eye_from_scene.translation().x() = kNaN;
  EXPECT_FALSE(solve());
  scene_.problem = sound;
  scene_.problem.points.front().point_scene.z() = kNaN;
  EXPECT_FALSE(solve());
  scene_.problem = sound;
  scene_.problem.points.front().observations.front().pixel.x() = kNaN;
  EXPECT_FALSE(solve());
  scene_.problem = sound;
  scene_.problem.camera.fx = kNaN;
  EXPECT_FALSE(solve());
  scene_.problem = sound;
  ASSERT_TRUE(solve());
}

TEST_F(OneStepInput, ThatIsEmptyHasNoAnswer) {
  scene_.problem.points.clear();
  EXPECT_FALSE(solve());
  scene_.problem.frames.clear();
  EXPECT_FALSE(solve());
}

TEST_F(OneStepInput, ThatContradictsItselfHasNoAnswer) {
  const OneStepProblem sound = scene_.problem;
  scene_.problem.points.front().observations.front().frame = -1;
  EXPECT_FALSE(solve());
  scene_.problem = sound;
  scene_.problem.points.front().observations.back().frame = 100000;
  EXPECT_FALSE(solve());
  scene_.problem = sound;
  std::swap(scene_.problem.points.front().observations.front(),
            scene_.problem.points.front().observations.back());
  EXPECT_FALSE(solve());
}

TEST_F(OneStepInput, WithTwoHandsHasNoAnswer) {
  for (std::size_t k = 2; k < scene_.problem.frames.size(); ++k)
    scene_.problem.frames[k].hand.reset();
  EXPECT_FALSE(solve());
}

TEST_F(OneStepInput, MayLackHandsForAWhile) {
  for (std::size_t k = 40; k < 90; ++k) scene_.problem.frames[k].hand.reset();
  const auto result = solve();
  ASSERT_TRUE(result);
  EXPECT_LT(error_in_sigmas(*result), 3.5);
  EXPECT_TRUE(result->eye_from_room[60]);
}

TEST_F(OneStepInput, MayHaveAWrongHandAtAKeyframe) {
  for (const std::size_t k : {std::size_t{20}, std::size_t{60}}) {
    ASSERT_TRUE(scene_.problem.frames[k].keyframe);
    scene_.problem.frames[k].hand->room_from_hand.translation().y() += 30.0;
  }
  const auto result = solve();
  ASSERT_TRUE(result);
  EXPECT_EQ(result->rejected, (std::vector<std::size_t>{20, 60}));
  EXPECT_LT(error_in_sigmas(*result), 3.5);
}

TEST_F(OneStepInput, MayHavePointsSeenTwice) {
  for (std::size_t j = 0; j < scene_.problem.points.size(); j += 2) {
    auto& seen = scene_.problem.points[j].observations;
    if (seen.size() > 2) seen.erase(seen.begin() + 1, seen.end() - 1);
  }
  const auto result = solve();
  ASSERT_TRUE(result);
  EXPECT_LT(error_in_sigmas(*result), 3.5);
}

/// Points that count for nothing do not make a keyframe of a frame.
TEST_F(OneStepInput, OfAKeyframeThatSeesTooLittleIsLeftOut) {
  constexpr int kPoor = 20;
  for (OneStepPoint& point : scene_.problem.points) {
    std::erase_if(point.observations, [](const auto& seen) { return seen.frame == kPoor; });
  }
  const Pose scene_from_eye = scene_.problem.frames[kPoor].eye_from_scene.inverse();
  for (int i = 0; i < 10; ++i) {
    const Eigen::Vector2d pixel(100 + 20 * i, 200);
    scene_.problem.points.push_back(
        {.point_scene = scene_from_eye * Eigen::Vector3d(0, 0.1 * i, -1),
         .observations = {{kPoor, pixel}, {kPoor + 4, pixel}}});
  }
  const auto scene = metric_scene(scene_.problem, start_);
  ASSERT_TRUE(scene);
  std::vector<int> seen(scene->keyframes(), 0);
  for (const MetricObservation& observation : scene->observations) ++seen[observation.keyframe];
  EXPECT_GE(std::ranges::min(seen), 6);
  const auto result = solve();
  ASSERT_TRUE(result);
  EXPECT_FALSE(result->eye_from_room[kPoor]);
  EXPECT_LT(error_in_sigmas(*result), 3.5);
}

TEST_F(OneStepInput, OfPartsThatTheStartLeftOutIsLeftOut) {
  for (PartResult& part : start_.parts) part.poses_used = 0;
  EXPECT_FALSE(solve());
}

TEST_F(OneStepInput, FarFromTheRoomsOriginHasTheSameAnswer) {
  const auto near = solve();
  const Eigen::Vector3d shift(3000, -2000, 1500);
  for (OneStepFrame& frame : scene_.problem.frames) {
    if (frame.hand) frame.hand->room_from_hand.translation() += shift;
  }
  for (PartResult& part : start_.parts) part.room_from_scene.translation() += shift;
  const auto far = solve();
  ASSERT_TRUE(near && far);
  EXPECT_LT((near->hand_from_eye.matrix() - far->hand_from_eye.matrix()).norm(), 1e-3);
}

}  // namespace
}  // namespace handeye
