// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/handeye/one_step_trials.hpp"

/// What the joint adjustment claims, against its errors.
namespace handeye {
namespace {

using synthetic::nees_band;
using synthetic::OneStepSceneOptions;
using synthetic::study;

constexpr int kSeeds = 25;
constexpr double kHonest = 3.5;  // error in its own standard deviations

OneStepSceneOptions all_keyframes() {
  OneStepSceneOptions options;
  options.keyframe_interval = 1;
  options.tracks.frames = 80;
  return options;
}

void expect_honest(const OneStepSceneOptions& options, HandNoiseSource source) {
  const auto figures = study(options, source, kSeeds, 0).one_step;
  EXPECT_EQ(figures.failures(), 0);
  const auto band = nees_band(kSeeds);
  EXPECT_GT(figures.mean_nees(), band.low);
  EXPECT_LT(figures.mean_nees(), band.high);
  EXPECT_LT(figures.worst(), kHonest);
  EXPECT_LT(std::abs(figures.offset_bias()), kHonest);
}

TEST(OneStepCovariance, IsHonestWithNoiseGiven) {
  expect_honest(all_keyframes(), HandNoiseSource::kGiven);
}

TEST(OneStepCovariance, IsHonestWithNoiseEstimated) {
  expect_honest(all_keyframes(), HandNoiseSource::kEstimated);
}

TEST(OneStepCovariance, IsHonestWithTheLensFree) {
  OneStepSceneOptions options = all_keyframes();
  options.lens = IntrinsicsMode::kRefine;
  expect_honest(options, HandNoiseSource::kEstimated);
}

/// A tracker slower than the camera: neighbouring frames share samples.
TEST(OneStepCovariance, IsHonestWhereFramesShareSamples) {
  OneStepSceneOptions options = all_keyframes();
  options.tracker_hz = 15;
  options.tracks.motion = [](double time_s) { return synthetic::free_hand(0.5 * time_s); };
  expect_honest(options, HandNoiseSource::kGiven);
}

/// Frames that are no keyframes count for what they say beyond the structure they hang on.
TEST(OneStepCovariance, IsHonestWhereFramesFollowKeyframes) {
  expect_honest({}, HandNoiseSource::kGiven);
  expect_honest({}, HandNoiseSource::kEstimated);
}

TEST(OneStepCovariance, IsHonestWhereFramesFollowWithTheLensFree) {
  OneStepSceneOptions options;
  options.lens = IntrinsicsMode::kRefine;
  expect_honest(options, HandNoiseSource::kEstimated);
}

/// Errors along a track that forget themselves slowly are fewer than they seem.
TEST(OneStepCovariance, SeesThatErrorsAlongATrackAgree) {
  OneStepSceneOptions options;
  options.tracks.noise_memory_s = 1.0;
  const auto figures = study(options, HandNoiseSource::kEstimated, 20, 0).one_step;
  EXPECT_LT(figures.worst(), kHonest);
  EXPECT_LT(figures.mean_nees(), 9.0);
}

}  // namespace
}  // namespace handeye
