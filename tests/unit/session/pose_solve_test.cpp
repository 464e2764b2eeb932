// SPDX-License-Identifier: BSD-3-Clause
// Poses alone: what is accepted is right, what cannot be solved is refused with the right reason.
#include "daemon/session/pose_solve.hpp"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/session/result_json.hpp"
#include "protocol/exit_codes.hpp"
#include "tests/unit/handeye/synthetic.hpp"

namespace handeye {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kUnitsPerMm = 0.0125;

double units_per_mm(ScaleMode scale) {
  return scale == ScaleMode::kKnown ? 1.0 : kUnitsPerMm;
}

std::vector<PosePair> poses_of(const synthetic::Motion& motion, ScaleMode scale, int count = 100,
                               const PoseNoise& noise = synthetic::tracker_and_camera()) {
  return synthetic::record(synthetic::scope(units_per_mm(scale)), motion, count, noise, 7).poses();
}

class BothScales : public ::testing::TestWithParam<ScaleMode> {
 protected:
  PoseSolution solve(const std::vector<PosePair>& poses) const {
    return solve_poses(poses, {.scale = GetParam()});
  }
  Reason reason_for(const std::vector<PosePair>& poses) const {
    const CalibrationResult result = solve(poses).calibration;
    EXPECT_EQ(result.verdict == Verdict::kAccepted, result.reason == Reason::kNone);
    EXPECT_EQ(result.advice, reason_advice(result.reason));
    EXPECT_EQ(to_json(result).dump().find("nan"), std::string::npos);
    return result.reason;
  }
  Reason reason_for(const synthetic::Motion& motion) const {
    return reason_for(poses_of(motion, GetParam()));
  }
};
INSTANTIATE_TEST_SUITE_P(Scales, BothScales,
                         ::testing::Values(ScaleMode::kKnown, ScaleMode::kUnknown),
                         [](const auto& scale) {
                           return scale.param == ScaleMode::kKnown ? "Known" : "Unknown";
                         });

TEST_P(BothScales, AcceptsGoodPosesAndIsRight) {
  const std::vector<PosePair> poses = poses_of(synthetic::free_hand, GetParam(), 200);
  const PoseSolution solution = solve(poses);
  const CalibrationResult& result = solution.calibration;
  ASSERT_EQ(result.verdict, Verdict::kAccepted) << reason_word(result.reason);
  const Vector6d error =
      synthetic::error_of(result.solution.hand_from_eye,
                          synthetic::scope(units_per_mm(GetParam())).solution.hand_from_eye);
  // Chi square of 6 degrees of freedom: 22.5 is exceeded once in a thousand.
  EXPECT_LT(error.dot(result.covariance.ldlt().solve(error)), 22.5);
  EXPECT_LT(result.sigma_rotation_deg, 0.05);
  EXPECT_LT(result.sigma_translation_mm, 0.5);
  EXPECT_NEAR(result.solution.scale_units_per_mm / units_per_mm(GetParam()), 1.0, 0.01);
  EXPECT_EQ(solution.poses, 200U);
  EXPECT_THAT(solution.wrong_poses, IsEmpty());
}

TEST_P(BothScales, ListsEveryMethodOfTheTableInItsOrder) {
  const CalibrationResult result = solve(poses_of(synthetic::free_hand, GetParam())).calibration;
  const auto table = methods(GetParam());
  ASSERT_EQ(result.methods.size(), table.size());
  for (std::size_t k = 0; k < table.size(); ++k) {
    const MethodResult& method = result.methods[k];
    EXPECT_EQ(method.name, table[k].name);
    ASSERT_TRUE(method.solution) << method.name;
    EXPECT_GT(method.residuals.rotation_deg, 0) << method.name;
    EXPECT_LT(method.residuals.rotation_deg, 1) << method.name;
    EXPECT_GT(method.time_ms, 0) << method.name;
  }
  const MethodResult& answer = result.methods.back();
  EXPECT_EQ(answer.name, "maximum_likelihood");
  EXPECT_EQ(answer.solution->hand_from_eye.matrix(), result.solution.hand_from_eye.matrix());
  ASSERT_TRUE(answer.sigma);
  EXPECT_EQ(answer.sigma->translation_mm, result.sigma_translation_mm);
}

TEST_P(BothScales, OneMethodAskedForIsListedAloneBesideTheAnswer) {
  const auto poses = poses_of(synthetic::free_hand, GetParam());
  const std::string name(methods(GetParam()).front().name);
  const CalibrationResult one =
      solve_poses(poses, {.scale = GetParam(), .method = name}).calibration;
  ASSERT_EQ(one.methods.size(), 1U);
  EXPECT_EQ(one.methods[0].name, name);
  EXPECT_EQ(one.solution.hand_from_eye.matrix(),
            solve(poses).calibration.solution.hand_from_eye.matrix());
}

TEST_P(BothScales, AMethodThatDoesNotExistIsAMistakeThatNamesThoseThatDo) {
  try {
    solve_poses({}, {.scale = GetParam(), .method = "newton"});
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("'newton'"));
    for (const Method& method : methods(GetParam())) {
      EXPECT_THAT(error.what(), HasSubstr(std::string(method.name)));
    }
  }
}

TEST_P(BothScales, TooFewPosesAreRefused) {
  const auto poses = poses_of(synthetic::free_hand, GetParam());
  EXPECT_EQ(reason_for(std::vector<PosePair>{}), Reason::kNoMotion);
  EXPECT_EQ(reason_for(std::vector<PosePair>{poses[0]}), Reason::kNoMotion);
  // One movement has one axis.
  EXPECT_EQ(reason_for(std::vector<PosePair>{poses[0], poses[40]}), Reason::kSingleAxis);
  EXPECT_NE(reason_for(std::vector<PosePair>{poses[0], poses[40], poses[80]}), Reason::kNone);
}

TEST_P(BothScales, IdenticalPosesAreNoMotion) {
  const PosePair pose = poses_of(synthetic::free_hand, GetParam()).front();
  EXPECT_EQ(reason_for(std::vector<PosePair>(50, pose)), Reason::kNoMotion);
  EXPECT_EQ(reason_for(synthetic::still), Reason::kNoMotion);
}

TEST_P(BothScales, PureTranslationIsInsufficientRotation) {
  EXPECT_EQ(reason_for(synthetic::translation_only), Reason::kInsufficientRotation);
  EXPECT_EQ(reason_for(poses_of(synthetic::translation_only, GetParam(), 100, {0, 0, 0, 0})),
            Reason::kInsufficientRotation);
}

TEST_P(BothScales, ParallelAxesAreASingleAxis) {
  EXPECT_EQ(reason_for(synthetic::one_axis), Reason::kSingleAxis);
  EXPECT_EQ(reason_for(poses_of(synthetic::one_axis, GetParam(), 100, {0, 0, 0, 0})),
            Reason::kSingleAxis);
}

TEST_P(BothScales, AFixedPointIsRefusedWhereTheScaleIsUnknownOnly) {
  const bool known = GetParam() == ScaleMode::kKnown;
  EXPECT_EQ(reason_for(synthetic::pivot), known ? Reason::kNone : Reason::kFixedPoint);
}

TEST_P(BothScales, WrongPosesAreFoundAndLeftOut) {
  const auto clean = poses_of(synthetic::free_hand, GetParam(), 60);
  auto poses = clean;
  std::mt19937 generator(5);
  const auto strays = synthetic::random_poses(
      synthetic::random_truth(generator, units_per_mm(GetParam())), generator, 3, 2.0);
  poses[6] = strays[0];
  poses[11].eye_from_scene = strays[1].eye_from_scene;
  poses[29].room_from_hand = strays[2].room_from_hand;
  const PoseSolution solution = solve(poses);
  EXPECT_THAT(solution.wrong_poses, ElementsAre(6, 11, 29));
  EXPECT_EQ(solution.calibration.verdict, Verdict::kAccepted);
  const Pose truth = synthetic::scope().solution.hand_from_eye;
  const Vector6d with = synthetic::error_of(solution.calibration.solution.hand_from_eye, truth);
  EXPECT_LT(with.head<3>().norm(), 3 * rad_from_deg(solution.calibration.sigma_rotation_deg));
  EXPECT_LT(with.tail<3>().norm(), 3 * solution.calibration.sigma_translation_mm);
}

TEST_P(BothScales, NumbersThatAreNoPosesAreNeverAccepted) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto good = poses_of(synthetic::free_hand, GetParam(), 40);
  for (const double bad : {nan, std::numeric_limits<double>::infinity(), 1e300}) {
    auto all = good;
    for (PosePair& pair : all) pair.eye_from_scene.translation().x() = bad;
    EXPECT_NE(reason_for(all), Reason::kNone) << bad;
    if (bad == 1e300) continue;  // one of these is a pose, if a strange one
    auto one = good;
    one[7].room_from_hand.translation().z() = bad;
    const PoseSolution solution = solve(one);
    EXPECT_THAT(solution.wrong_poses, ElementsAre(7)) << bad;
    EXPECT_TRUE(solution.calibration.solution.hand_from_eye.matrix().allFinite()) << bad;
  }
  auto sheared = good;
  for (PosePair& pair : sheared) pair.room_from_hand.linear().col(0) *= 2;
  EXPECT_NE(reason_for(sheared), Reason::kNone);
}

TEST(PoseSolve, NoiseThatIsGivenIsBelieved) {
  const PoseNoise truth = synthetic::tracker_and_camera();
  const auto poses = poses_of(synthetic::free_hand, ScaleMode::kKnown, 100, truth);
  PoseSolveOptions options{.scale = ScaleMode::kKnown};
  options.hand_noise =
      DeviceNoise{deg_from_rad(truth.hand_rotation_rad), truth.hand_translation_mm};
  options.eye_noise = DeviceNoise{deg_from_rad(truth.eye_rotation_rad), truth.eye_translation_mm};
  const PoseSolution solution = solve_poses(poses, options);
  EXPECT_FALSE(solution.noise_estimated);
  EXPECT_DOUBLE_EQ(solution.noise.hand_rotation_rad, truth.hand_rotation_rad);
  EXPECT_DOUBLE_EQ(solution.noise.eye_translation_mm, truth.eye_translation_mm);
  // Twice the noise, twice the uncertainty.
  options.hand_noise->rotation_deg *= 2;
  options.hand_noise->translation_mm *= 2;
  options.eye_noise->rotation_deg *= 2;
  options.eye_noise->translation_mm *= 2;
  const PoseSolution doubled = solve_poses(poses, options);
  EXPECT_NEAR(doubled.calibration.sigma_rotation_deg / solution.calibration.sigma_rotation_deg, 2,
              0.05);
}

TEST(PoseSolve, ResidualsBeyondTheNoiseGivenWidenEverySigmaAlike) {
  const PoseNoise truth = synthetic::tracker_and_camera();
  const auto poses = poses_of(synthetic::free_hand, ScaleMode::kKnown, 100, truth);
  const auto given = [&](double factor) {
    PoseSolveOptions options{.scale = ScaleMode::kKnown};
    options.hand_noise = DeviceNoise{factor * deg_from_rad(truth.hand_rotation_rad),
                                     factor * truth.hand_translation_mm};
    // Shared out between the positions of hand and eye by nothing but what was given.
    options.eye_noise = DeviceNoise{factor * deg_from_rad(truth.eye_rotation_rad),
                                    factor * 3 * truth.eye_translation_mm};
    return solve_poses(poses, options);
  };
  const PoseSolution fair = given(1);
  const PoseSolution small = given(0.2);
  EXPECT_DOUBLE_EQ(fair.noise_factor, 1);
  EXPECT_DOUBLE_EQ(fair.noise.eye_translation_mm, 3 * truth.eye_translation_mm);
  EXPECT_GT(small.noise_factor, 1.5);
  EXPECT_LT(small.noise_factor, 5.5);
  EXPECT_DOUBLE_EQ(small.noise.hand_translation_mm, 0.2 * truth.hand_translation_mm);
  ASSERT_EQ(fair.calibration.methods.size(), small.calibration.methods.size());
  for (std::size_t i = 0; i + 1 < fair.calibration.methods.size(); ++i) {
    const MethodResult& method = small.calibration.methods[i];
    if (!method.sigma || !fair.calibration.methods[i].sigma) continue;
    EXPECT_NEAR(method.sigma->rotation_deg / fair.calibration.methods[i].sigma->rotation_deg,
                0.2 * small.noise_factor, 0.1 * 0.2 * small.noise_factor)
        << method.name;
  }
}

TEST(PoseSolve, NoiseThatNothingHasIsAMistake) {
  for (const double bad : {0.0, 1e-10, 1e7, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(solve_poses({}, {.hand_noise = DeviceNoise{bad, 0.1}}), UsageError) << bad;
    EXPECT_THROW(solve_poses({}, {.eye_noise = DeviceNoise{0.1, bad}}), UsageError) << bad;
  }
}

TEST(PoseSolve, SigmaWantedDecides) {
  const auto poses = poses_of(synthetic::free_hand, ScaleMode::kKnown, 200);
  const CalibrationResult accepted = solve_poses(poses, {.scale = ScaleMode::kKnown}).calibration;
  PoseSolveOptions strict{.scale = ScaleMode::kKnown};
  strict.wanted = {0.9 * accepted.sigma_rotation_deg, 1.5};
  EXPECT_EQ(accepted.verdict, Verdict::kAccepted);
  EXPECT_EQ(solve_poses(poses, strict).calibration.reason, Reason::kUncertain);
}

TEST(PoseSolve, SaysTheSameEveryTime) {
  const auto poses = poses_of(synthetic::free_hand, ScaleMode::kUnknown);
  const auto json = [&] {
    auto document = to_json(solve_poses(poses, {}).calibration);
    document.erase("timings_ms");
    for (auto& method : document["methods"]) method.erase("time_ms");
    return document.dump();
  };
  EXPECT_EQ(json(), json());
}

}  // namespace
}  // namespace handeye
