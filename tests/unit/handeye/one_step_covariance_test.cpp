// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/handeye/one_step_trials.hpp"

/// What the joint adjustment claims, against its errors.
namespace handeye {
namespace {

using synthetic::nees_band;
using synthetic::one_step_options;
using synthetic::one_step_scene;
using synthetic::OneStepSceneOptions;
using synthetic::start_of;
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

/// How long the path is: all that scale means.
TEST(OneStepCovariance, KnowsHowSureItIsOfTheScale) {
  const auto log_spread = [](const std::vector<Eigen::Vector3d>& path) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& centre : path) mean += centre / static_cast<double>(path.size());
    double squares = 0;
    for (const Eigen::Vector3d& centre : path) squares += (centre - mean).squaredNorm();
    return 0.5 * std::log(squares);
  };
  double squares = 0;
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    const synthetic::OneStepScene scene = one_step_scene({}, seed);
    const auto found = one_step(scene.problem, *start_of(scene),
                                one_step_options(scene, HandNoiseSource::kEstimated));
    ASSERT_TRUE(found);
    std::vector<Eigen::Vector3d> path;
    std::vector<Eigen::Vector3d> truth;
    for (std::size_t k = 0; k < scene.problem.frames.size(); ++k) {
      if (!scene.problem.frames[k].keyframe) continue;
      path.push_back(found->eye_from_room[k]->inverse().translation());
      truth.push_back(scene.tracks.eye_from_room[k].inverse().translation());
    }
    const double off = log_spread(path) - log_spread(truth);
    squares += off * off / (found->log_scale_sigma * found->log_scale_sigma);
  }
  // 99.8 % of a sum of so many squared normal deviates.
  EXPECT_GT(squares, 8.6);
  EXPECT_LT(squares, 52.7);
}

/// Errors along a track that forget themselves slowly are fewer than they seem; most of that is
/// seen (over 100 seeds NEES is 7.9 for 6).
TEST(OneStepCovariance, SeesThatErrorsAlongATrackAgree) {
  OneStepSceneOptions options;
  options.tracks.noise_memory_s = 1.0;
  const auto figures = study(options, HandNoiseSource::kEstimated, 20, 0).one_step;
  EXPECT_LT(figures.worst(), kHonest);
  EXPECT_LT(figures.mean_nees(), nees_band(20).high);
}

}  // namespace
}  // namespace handeye
