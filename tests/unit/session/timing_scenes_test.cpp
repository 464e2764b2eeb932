// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/session/timing_scenes.hpp"

#include <gtest/gtest.h>

/// From images and datagrams to the verdict; over many seeds: tests/bench/degenerate.
namespace handeye::timing {
namespace {

/// Of 12 s at 320x240: half the resolution and little more than half the time that the design's
/// targets are for (0.10 deg, 0.5 mm, 1 ms).
constexpr double kMostRotation_deg = 0.20;
constexpr double kMostTranslation_mm = 1.0;
constexpr double kMostOffset_s = 0.002;

class TimingScene : public testing::TestWithParam<std::string_view> {
 protected:
  static const Footage& footage() {
    static const Footage footage(1);
    return footage;
  }
};

TEST_P(TimingScene, IsAnsweredRightlyOrRefused) {
  const Scene& each = scene(GetParam());
  const Trial trial = run(each, footage());
  EXPECT_TRUE(is_right(each, trial)) << describe(trial);
  if (!trial.accepted()) return;
  EXPECT_LT(trial.rotation_error_deg, kMostRotation_deg) << describe(trial);
  EXPECT_LT(trial.translation_error_mm, kMostTranslation_mm) << describe(trial);
  EXPECT_LT(trial.time_offset_error_s, kMostOffset_s) << describe(trial);
  RecordProperty("answer", describe(trial));
}

std::vector<std::string_view> names() {
  std::vector<std::string_view> names;
  for (const Scene& each : scenes()) names.push_back(each.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Scenes, TimingScene, testing::ValuesIn(names()),
                         [](const auto& each) { return std::string(each.param); });

}  // namespace
}  // namespace handeye::timing
