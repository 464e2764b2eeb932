// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/session/degenerate_scenes.hpp"

#include <gtest/gtest.h>

/// From rendered images to the verdict; over many seeds: tests/bench/degenerate.
namespace handeye::degenerate {
namespace {

constexpr std::uint64_t kSeed = 1;

struct Length {
  std::string_view scene;
  double duration_s;  ///< long enough for what the scene is about
};

class DegenerateScene : public testing::TestWithParam<Length> {};

TEST_P(DegenerateScene, IsNeverAnsweredWrongly) {
  const Scene& each = scene(GetParam().scene);
  const Trial trial = run(each, kSeed, GetParam().duration_s);
  EXPECT_TRUE(is_right(each, trial)) << describe(trial);
}

std::string name_of(const testing::TestParamInfo<Length>& info) {
  return std::string(info.param.scene);
}

INSTANTIATE_TEST_SUITE_P(Scenes, DegenerateScene,
                         testing::Values(Length{"plane", 4}, Length{"bare", 3},
                                         Length{"instrument", 5}, Length{"covered_lens", 8},
                                         Length{"rotation", 4},
                                         Length{"pivot_with_covered_lens", 8}),
                         name_of);

}  // namespace
}  // namespace handeye::degenerate
