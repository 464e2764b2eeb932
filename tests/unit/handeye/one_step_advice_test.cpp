// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "daemon/handeye/motion_facts.hpp"
#include "tests/unit/handeye/one_step_degenerate.hpp"

/// Advice, by construction: one thing is left out of a good motion; it is named; it is added, and
/// the answer is accepted.
namespace handeye {
namespace {

using synthetic::MotionShape;
using synthetic::OneStepSceneOptions;
using synthetic::Verdict;

constexpr std::uint32_t kSeeds = 3;

Verdict verdict(const MotionShape& shape, std::uint32_t seed, const JudgeOptions& wanted = {},
                int frames = 130) {
  OneStepSceneOptions options;
  options.tracks.motion = synthetic::shaped_motion(shape);
  options.tracks.frames = frames;
  return synthetic::verdicts(options, seed, wanted).one_step;
}

struct LeftOut {
  const char* name;
  MotionShape without;
  MotionShape with;  ///< the same with what was advised
  MissingMotion missing;
};

const std::vector<LeftOut>& left_out() {
  const Eigen::Vector3d slide(15, 15, 15);
  static const std::vector<LeftOut> kCases{
      {"AllButTilting",
       {{20, 0, 0}, slide},
       {{20, 20, 0}, slide},
       MissingMotion::kTurnLeftAndRight},
      {"AllButTurning", {{0, 20, 0}, slide}, {{20, 20, 0}, slide}, MissingMotion::kTiltUpAndDown},
      {"AllButRolling", {{0, 0, 20}, slide}, {{20, 0, 20}, slide}, MissingMotion::kTiltUpAndDown},
      {"SlidingInAndOut",
       {{20, 20, 20}, {0, 0, 0}, synthetic::kTrocar_mm},
       {{20, 20, 20}, {0, 0, 30}, synthetic::kTrocar_mm},
       MissingMotion::kSlideInAndOut},
      {"SlidingSideways",
       {{20, 20, 20}, {0, 0, 0}, {0, 0, 0}},
       {{20, 20, 20}, {15, 15, 0}, {0, 0, 0}},
       MissingMotion::kSlideSideways},
  };
  return kCases;
}

std::string describe(const Verdict& verdict) {
  return fmt::format("{} {:.3f} deg {:.3f} mm", word(verdict.judgement.missing),
                     sigma_rotation_deg(verdict.judgement.covariance),
                     sigma_translation_mm(verdict.judgement.covariance));
}

class OneStepAdvice : public testing::TestWithParam<std::size_t> {};

TEST_P(OneStepAdvice, NamesWhatIsMissingAndIsRight) {
  const LeftOut& each = left_out()[GetParam()];
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    const Verdict without = verdict(each.without, seed);
    EXPECT_FALSE(without.accepted()) << seed;
    EXPECT_EQ(word(without.judgement.missing), word(each.missing)) << seed;
    const Verdict with = verdict(each.with, seed, {}, 260);
    EXPECT_TRUE(with.accepted()) << seed << ": " << describe(with);
  }
}

std::string name_of(const testing::TestParamInfo<std::size_t>& info) {
  return left_out()[info.param].name;
}

INSTANTIATE_TEST_SUITE_P(Cases, OneStepAdvice, testing::Range<std::size_t>(0, left_out().size()),
                         name_of);

/// Two axes do determine an answer; who wants it better is told of the third.
class OneStepAdviceOfThree : public testing::TestWithParam<int> {};

TEST_P(OneStepAdviceOfThree, NamesTheAxisThatIsMissing) {
  constexpr MissingMotion kAbout[]{MissingMotion::kTiltUpAndDown, MissingMotion::kTurnLeftAndRight,
                                   MissingMotion::kRoll};
  MotionShape two;
  two.turn_deg[GetParam()] = 1;
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    const double sigma_of_two = sigma_rotation_deg(verdict(two, seed).judgement.covariance);
    const JudgeOptions wanted{.wanted_rotation_deg = 0.95 * sigma_of_two,
                              .wanted_translation_mm = 5};
    const Verdict without = verdict(two, seed, wanted);
    EXPECT_EQ(without.judgement.problem, MotionProblem::kUncertain) << seed;
    EXPECT_EQ(word(without.judgement.missing), word(kAbout[GetParam()]))
        << seed << ": " << describe(without);
    EXPECT_TRUE(verdict({}, seed, wanted, 230).accepted()) << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Axes, OneStepAdviceOfThree, testing::Range(0, 3));

/// Everything was there, only not for long enough.
TEST(OneStepAdviceForMore, IsToGoOn) {
  const JudgeOptions wanted{.wanted_rotation_deg = 0.1, .wanted_translation_mm = 5};
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    const Verdict little = verdict({}, seed, wanted, 60);
    EXPECT_EQ(little.judgement.problem, MotionProblem::kUncertain) << seed;
    EXPECT_EQ(word(little.judgement.missing), "keep_moving") << seed;
    EXPECT_TRUE(verdict({}, seed, wanted, 240).accepted()) << seed;
  }
}

TEST(TurnedDeg, IsAboutTheAxesOfTheCamera) {
  const Pose hand_from_eye = synthetic::scope().solution.hand_from_eye;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Pose> room_from_hand;
    for (int k = 0; k < 100; ++k) {
      Pose turn = Pose::Identity();
      turn.linear() =
          exp_so3(rad_from_deg(20) * std::sin(2 * kPi * k / 100) * Eigen::Vector3d::Unit(axis));
      room_from_hand.push_back(synthetic::still(0) * turn * hand_from_eye.inverse());
    }
    const Eigen::Vector3d turned = turned_deg(room_from_hand, hand_from_eye);
    for (int other = 0; other < 3; ++other) {
      EXPECT_NEAR(turned[other], other == axis ? 20 / std::sqrt(2.0) : 0.0, 1e-6);
    }
  }
  EXPECT_EQ(turned_deg({}, hand_from_eye), Eigen::Vector3d::Zero());
}

TEST(MissingMotionWords, AreThereForEveryOne) {
  for (const MissingMotion missing :
       {MissingMotion::kTiltUpAndDown, MissingMotion::kTurnLeftAndRight, MissingMotion::kRoll,
        MissingMotion::kSlideInAndOut, MissingMotion::kSlideSideways, MissingMotion::kKeepMoving}) {
    EXPECT_FALSE(word(missing).empty());
    EXPECT_EQ(word(missing).find(' '), std::string_view::npos);
    EXPECT_FALSE(words(missing).empty());
  }
  EXPECT_TRUE(word(MissingMotion::kNone).empty());
  EXPECT_TRUE(words(MissingMotion::kNone).empty());
}

}  // namespace
}  // namespace handeye
