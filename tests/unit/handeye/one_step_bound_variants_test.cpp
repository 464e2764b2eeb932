// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <string_view>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/unit/handeye/one_step_trials.hpp"

/// As it is in the daemon: a fourth of the frames are keyframes, the others follow; and what goes
/// wrong with trackers and tracks.
namespace handeye {
namespace {

using synthetic::OneStepFigures;
using synthetic::OneStepSceneOptions;
using synthetic::OneStepStudy;

constexpr int kSeeds = 30;

OneStepStudy study(std::string_view name, const OneStepSceneOptions& options,
                   HandNoiseSource source = HandNoiseSource::kEstimated) {
  const OneStepStudy found = synthetic::study(options, source, kSeeds, 3);
  fmt::print("{}{:<34} {}\n", synthetic::header(), name, row(found.one_step));
  std::fflush(stdout);
  EXPECT_EQ(found.one_step.failures(), 0);
  return found;
}

void expect_honest(const OneStepFigures& figures) {
  EXPECT_LT(figures.mean_nees(), synthetic::nees_band(figures.trials()).high);
  EXPECT_LT(figures.worst(), 3.5);
  EXPECT_LT(figures.offset_bias(), 3.3);
  EXPECT_LE(figures.rms_offset_s(), 0.0005);
}

void expect_better_than_the_start(const OneStepStudy& study) {
  EXPECT_LT(study.one_step.rms_rotation_deg(), study.likelihood.rms_rotation_deg());
  EXPECT_LT(study.one_step.rms_translation_mm(), study.likelihood.rms_translation_mm());
}

TEST(OneStepBoundVariants, FewKeyframes) {
  const OneStepStudy found = study("every fourth a keyframe", {});
  expect_honest(found.one_step);
  expect_better_than_the_start(found);
  // The bound knows what all frames saw, one_step but what the keyframes did.
  EXPECT_LT(found.one_step.rotation_to_bound(), 1.5);
  EXPECT_LT(found.one_step.translation_to_bound(), 1.5);
}

TEST(OneStepBoundVariants, NoiseGiven) {
  expect_honest(study("noise given", {}, HandNoiseSource::kGiven).one_step);
}

TEST(OneStepBoundVariants, SeveralParts) {
  OneStepSceneOptions options;
  options.tracks.parts = 3;
  options.tracks.frames = 180;
  const OneStepStudy found = study("three parts", options);
  expect_honest(found.one_step);
  expect_better_than_the_start(found);
}

TEST(OneStepBoundVariants, GrossOutliersOfTheTracker) {
  OneStepSceneOptions options;
  options.outlier_samples = 0.05;
  const OneStepStudy clean = study("clean", {});
  const OneStepStudy found = study("5 % gross outliers", options);
  EXPECT_LT(found.one_step.worst(), 3.5);
  EXPECT_LT(found.one_step.rms_rotation_deg(), 1.4 * clean.one_step.rms_rotation_deg());
  EXPECT_LT(found.one_step.rms_translation_mm(), 1.4 * clean.one_step.rms_translation_mm());
}

/// A tenth of the tracks six times as noisy costs next to nothing: they are weighed by what they
/// show. The bound is of all tracks alike.
TEST(OneStepBoundVariants, BadTracks) {
  OneStepSceneOptions options;
  options.keyframe_interval = 1;
  options.tracks.bad_tracks = 0.1;
  const OneStepStudy found = study("a tenth bad tracks", options);
  expect_honest(found.one_step);
  EXPECT_LT(found.one_step.rotation_to_bound(), 1.25);
  EXPECT_LT(found.one_step.translation_to_bound(), 1.25);
}

/// All samples of the tracker instead of the two around each frame.
TEST(OneStepBoundVariants, SmoothHands) {
  OneStepSceneOptions options;
  options.keyframe_interval = 1;
  const OneStepStudy line = study("hands on a line", options);
  options.smooth_hands = true;
  const OneStepStudy smooth = study("smooth hands", options);
  expect_honest(smooth.one_step);
  EXPECT_LT(smooth.one_step.rms_rotation_deg(), 0.97 * line.one_step.rms_rotation_deg());
  EXPECT_LT(smooth.one_step.rms_translation_mm(), 0.97 * line.one_step.rms_translation_mm());
}

/// What the tracker says of each sample is worth more than one figure for all.
TEST(OneStepBoundVariants, MeasuredNoiseBeatsGivenNoise) {
  OneStepSceneOptions options;
  options.hand_noise_varies = true;
  const OneStepStudy given = study("varying noise, given", options, HandNoiseSource::kGiven);
  const OneStepStudy measured =
      study("varying noise, measured", options, HandNoiseSource::kMeasured);
  expect_honest(measured.one_step);
  EXPECT_LT(measured.one_step.rms_rotation_deg(), 0.9 * given.one_step.rms_rotation_deg());
  EXPECT_LT(measured.one_step.rms_translation_mm(), 0.9 * given.one_step.rms_translation_mm());
}

/// Tracks that drift together over half a second: what is claimed may be too bold, but not by more
/// than half.
TEST(OneStepBoundVariants, DriftingTracks) {
  OneStepSceneOptions options;
  options.tracks.noise_memory_s = 0.4;
  const OneStepFigures found = study("drifting tracks", options).one_step;
  EXPECT_LT(found.rms_rotation_deg(), 1.5 * found.claimed_rotation_deg());
  EXPECT_LT(found.rms_translation_mm(), 1.5 * found.claimed_translation_mm());
  EXPECT_LT(found.worst(), 3.5);
}

}  // namespace
}  // namespace handeye
