// SPDX-License-Identifier: BSD-3-Clause
#include <ostream>

#include <gmock/gmock.h>

#include "tests/unit/session/degenerate_scenes.hpp"

/// The motions that cannot be enough, each refused with its own reason and the one thing that
/// mends it.
namespace handeye::degenerate {
namespace {

constexpr std::uint64_t kSeed = 2;
constexpr double kDuration_s = 5;

struct BadMotion {
  std::string_view scene;
  Reason reason;
  std::vector<std::string> missing;  ///< any of these words
};

void PrintTo(const BadMotion& motion, std::ostream* out) {
  *out << motion.scene;
}

class BadMotionTest : public testing::TestWithParam<BadMotion> {};

TEST_P(BadMotionTest, IsRefusedWithItsOwnReasonAndAdvice) {
  const Trial trial = run(scene(GetParam().scene), kSeed, kDuration_s);
  EXPECT_EQ(trial.result.verdict, Verdict::kRefused) << describe(trial);
  EXPECT_EQ(trial.result.reason, GetParam().reason) << describe(trial);
  EXPECT_FALSE(trial.result.advice.empty());
  EXPECT_THAT(GetParam().missing, testing::Contains(trial.result.missing)) << describe(trial);
}

INSTANTIATE_TEST_SUITE_P(
    Motions, BadMotionTest,
    testing::Values(
        // Everything is missing; tilting is what to begin with.
        BadMotion{"static", Reason::kNoMotion, {"tilt_up_and_down", "keep_moving"}},
        BadMotion{"wobble", Reason::kNoMotion, {"tilt_up_and_down", "keep_moving"}},
        BadMotion{"translation",
                  Reason::kInsufficientRotation,
                  {"tilt_up_and_down", "turn_left_and_right", "roll"}},
        BadMotion{"rotation", Reason::kNoParallax, {"slide_sideways", "slide_in_and_out"}},
        BadMotion{"single_axis",
                  Reason::kSingleAxis,
                  {"tilt_up_and_down", "turn_left_and_right", "roll"}},
        BadMotion{"pivot", Reason::kFixedPoint, {"slide_in_and_out"}}),
    [](const auto& motion) { return std::string(motion.param.scene); });

TEST(GoodMotion, APivotThatSlidesIsAnswered) {
  const Scene& sliding = scene("pivot_slide");
  const Trial trial = run(sliding, kSeed, 2 * kDuration_s);
  EXPECT_TRUE(trial.accepted()) << describe(trial);
  EXPECT_TRUE(is_right(sliding, trial)) << describe(trial);
}

}  // namespace
}  // namespace handeye::degenerate
