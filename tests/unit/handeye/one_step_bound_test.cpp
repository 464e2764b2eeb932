// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/unit/handeye/one_step_trials.hpp"

/// one_step against the Cramer-Rao bound of the same problem (docs/math.md section 8): every frame
/// a keyframe, so that what the bound knows is what one_step is given.
namespace handeye {
namespace {

using synthetic::OneStepFigures;
using synthetic::OneStepSceneOptions;

constexpr int kSeeds = 100;
constexpr double kToBound = 1.2;
constexpr double kMaxOffset_s = 0.0005;

OneStepSceneOptions all_keyframes(std::optional<IntrinsicsMode> lens) {
  OneStepSceneOptions options;
  options.keyframe_interval = 1;
  options.tracks.frames = 100;
  options.tracks.features = 30;
  options.lens = lens;
  return options;
}

void expect_at_the_bound(const OneStepFigures& figures) {
  fmt::print("{}{:<34} {}\n", synthetic::header(), "one_step", row(figures));
  std::fflush(stdout);
  EXPECT_EQ(figures.failures(), 0);
  EXPECT_LE(figures.rotation_to_bound(), kToBound);
  EXPECT_LE(figures.translation_to_bound(), kToBound);
  const auto band = synthetic::nees_band(figures.trials());
  EXPECT_GT(figures.mean_nees(), band.low);
  EXPECT_LT(figures.mean_nees(), band.high);
  EXPECT_LT(figures.offset_bias(), 3.3);
  EXPECT_LE(figures.rms_offset_s(), kMaxOffset_s);
}

TEST(OneStepBound, IsReachedWithTheLensGiven) {
  expect_at_the_bound(
      synthetic::study(all_keyframes(std::nullopt), HandNoiseSource::kEstimated, kSeeds, 5)
          .one_step);
}

TEST(OneStepBound, IsReachedWithTheLensFree) {
  expect_at_the_bound(synthetic::study(all_keyframes(IntrinsicsMode::kEstimate),
                                       HandNoiseSource::kEstimated, kSeeds, 5)
                          .one_step);
}

}  // namespace
}  // namespace handeye
