// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/unit/handeye/one_step_trials.hpp"

/// Hands that are interpolated between samples, and frames that share them (docs/math.md 8).
namespace handeye {
namespace {

using synthetic::OneStepScene;
using synthetic::OneStepSceneOptions;

/// Translation errors of the looked-up hands in standard deviations of a sample, by the truth.
Eigen::Matrix3Xd hand_errors(const OneStepScene& scene) {
  const auto frames = static_cast<Eigen::Index>(scene.problem.frames.size());
  Eigen::Matrix3Xd errors(3, frames);
  for (Eigen::Index k = 0; k < frames; ++k) {
    const HandAtFrame& hand = *scene.problem.frames[static_cast<std::size_t>(k)].hand;
    const double time_s = scene.options.tracks.from_s + scene.time_offset_error_s +
                          static_cast<double>(k) / scene.options.tracks.rate_hz;
    const Pose truth = scene.options.tracks.motion(time_s) * scene.hand_from_eye.inverse();
    errors.col(k) = (hand.room_from_hand.translation() - truth.translation()) /
                    scene.options.hand_translation_sigma_mm;
  }
  return errors;
}

/// The scenes are what the bound takes them for: the variance falls between samples by
/// (1-a)^2 + a^2, and frames with a common sample err together.
TEST(OneStepInterpolation, LowersTheNoiseAndCorrelatesNeighbours) {
  OneStepSceneOptions options;
  options.tracker_hz = 30;
  options.tracks.rate_hz = 60;
  options.tracks.features = 12;
  double chi2 = 0, product = 0, expected_product = 0;
  int count = 0;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    const OneStepScene scene = synthetic::one_step_scene(options, seed);
    const Eigen::Matrix3Xd errors = hand_errors(scene);
    for (Eigen::Index k = 0; k + 1 < errors.cols(); ++k) {
      const HandAtFrame& a = *scene.problem.frames[static_cast<std::size_t>(k)].hand;
      const HandAtFrame& b = *scene.problem.frames[static_cast<std::size_t>(k) + 1].hand;
      const double f = a.shares[1];
      chi2 += errors.col(k).squaredNorm() / (a.shares[0] * a.shares[0] + f * f);
      product += errors.col(k).dot(errors.col(k + 1));
      // Half a sample apart: the same two, or one in common.
      expected_product += 3 * (a.sample == b.sample ? a.shares[0] * b.shares[0] + f * b.shares[1]
                                                    : f * b.shares[0]);
      count += 3;
    }
  }
  // 15 000 values, hardly 5000 of them independent: 3.3 standard deviations are 6 %.
  EXPECT_NEAR(chi2 / count, 1.0, 0.06);
  EXPECT_NEAR(product / expected_product, 1.0, 0.08);
  EXPECT_GT(expected_product / count, 0.3);
}

/// The camera sees the hand twice as often as the tracker does: neighbours share their samples'
/// errors, and the covariance must not count them twice.
TEST(OneStepInterpolation, OfFramesThatShareSamplesIsHonest) {
  OneStepSceneOptions options;
  options.tracker_hz = 30;
  options.tracks.rate_hz = 60;
  options.tracks.frames = 180;
  options.tracks.features = 30;
  options.keyframe_interval = 2;
  const auto found = synthetic::study(options, HandNoiseSource::kEstimated, 100, 20).one_step;
  fmt::print("{}{:<34} {}\n", synthetic::header(), "30 Hz tracker, 60 Hz camera", row(found));
  std::fflush(stdout);
  const auto band = synthetic::nees_band(found.trials());
  EXPECT_GT(found.mean_nees(), band.low);
  EXPECT_LT(found.mean_nees(), band.high);
  EXPECT_LT(found.offset_bias(), 3.3);
}

}  // namespace
}  // namespace handeye
