// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/calibration_watch.hpp"

#include <optional>

#include <gtest/gtest.h>

#include "tests/unit/session/watch_scene.hpp"

namespace handeye::test {
namespace {

/// Motion since the turn [s] until it was said to be broken.
std::optional<double> said_broken_after(const WatchSceneOptions& options) {
  WatchScene scene(options);
  CalibrationWatch watch(scene.calibration());
  while (scene.time_s() < options.turned_at_s + 60.0) {
    const bool broken = watch.status(scene.next(watch)).state == WatchState::kBroken;
    if (!broken) continue;
    EXPECT_GE(scene.time_s(), options.turned_at_s) << "said before it was turned";
    return scene.moved_since_turn_s();
  }
  return std::nullopt;
}

class TurnedHead : public testing::TestWithParam<unsigned> {};

TEST_P(TurnedHead, RollOf5DegIsSaidWithin10sOfMotion) {
  const auto after_s =
      said_broken_after({.seed = GetParam(), .turned_at_s = 12.0, .turn_deg = {0, 0, 5}});
  ASSERT_TRUE(after_s);
  EXPECT_LE(*after_s, 10.0);
}

TEST_P(TurnedHead, TiltOf1DegIsSaidWithin10sOfFreeMotion) {
  WatchSceneOptions options{.seed = GetParam(), .turned_at_s = 12.0, .turn_deg = {1, 0, 0}};
  options.motions = {MotionKind::kFree};
  const auto after_s = said_broken_after(options);
  ASSERT_TRUE(after_s);
  EXPECT_LE(*after_s, 10.0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, TurnedHead, testing::Values(1001U, 1002U));

/// 30 minutes of use with all that goes with it, accelerated: half of it each, for a watch
/// remembers a minute at most. watch_table has them in one piece.
class UnchangedHead : public testing::TestWithParam<unsigned> {};

TEST_P(UnchangedHead, IsNeverReported) {
  WatchScene scene({.seed = GetParam()});
  CalibrationWatch watch(scene.calibration());
  double holding_s = 0;
  double all_s = 0;
  while (scene.time_s() < 15.0 * 60.0) {
    const double before_s = scene.time_s();
    const WatchStatus status = watch.status(scene.next(watch));
    ASSERT_NE(status.state, WatchState::kBroken) << "at " << scene.time_s() << " s";
    ASSERT_NE(status.state, WatchState::kDoubtful) << "at " << scene.time_s() << " s";
    all_s += scene.time_s() - before_s;
    if (status.state == WatchState::kHolds) holding_s += scene.time_s() - before_s;
  }
  EXPECT_GT(holding_s, 0.7 * all_s) << "a watch that never sees anything never lies";
}

INSTANTIATE_TEST_SUITE_P(Seeds, UnchangedHead, testing::Values(5001U, 5002U));

TEST(CalibrationWatch, SaysNothingWithoutMotion) {
  WatchSceneOptions options{.seed = 3};
  options.motions = {MotionKind::kPause};
  WatchScene scene(options);
  CalibrationWatch watch(scene.calibration());
  WatchStatus status;
  while (scene.time_s() < 30.0) status = watch.status(scene.next(watch));
  EXPECT_EQ(status.state, WatchState::kUnchecked);
  EXPECT_EQ(status.age_s, -1);
  EXPECT_FALSE(status.text.empty());
}

}  // namespace
}  // namespace handeye::test
