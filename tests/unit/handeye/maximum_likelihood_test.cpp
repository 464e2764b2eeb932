// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/maximum_likelihood.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "tests/unit/handeye/synthetic.hpp"

namespace handeye {
namespace {

using synthetic::free_hand;
using synthetic::record;
using synthetic::Recording;
using synthetic::scope;
using synthetic::tracker_and_camera;
using synthetic::Truth;

std::vector<HandEyeObservation> observed(const std::vector<PosePair>& poses) {
  std::vector<HandEyeObservation> observations;
  for (const PosePair& pair : poses) observations.push_back({pair, {0, 0, 0}, {0, 0, 0}});
  return observations;
}

double nees(const MaximumLikelihoodResult& result, const Truth& truth) {
  const Vector6d error =
      synthetic::error_of(result.solution.hand_from_eye, truth.solution.hand_from_eye);
  return error.dot(result.covariance.ldlt().solve(error));
}

TEST(MaximumLikelihood, IsExactOnExactDataWhateverTheScale) {
  std::mt19937 generator(1);
  for (int trial = 0; trial < 30; ++trial) {
    const Truth truth = synthetic::random_truth(generator, std::pow(10.0, -6 + 12 * trial / 29.0));
    const auto poses = synthetic::random_poses(truth, generator, 20, rad_from_deg(60));
    const auto found = maximum_likelihood(observed(poses));
    ASSERT_TRUE(found);
    const Vector6d error =
        synthetic::error_of(found->solution.hand_from_eye, truth.solution.hand_from_eye);
    EXPECT_LT(error.head<3>().norm(), 1e-9);
    EXPECT_LT(error.tail<3>().norm(), 1e-6);
    EXPECT_NEAR(found->solution.scale_units_per_mm / truth.solution.scale_units_per_mm, 1, 1e-8);
    EXPECT_TRUE(found->room_from_scene.isApprox(truth.room_from_scene, 1e-8));
  }
}

TEST(MaximumLikelihood, ReachesTheTargetsOnTheSimulatorsMotion) {
  const Truth truth = scope(0.0123);
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    for (const int count : {150, 500}) {
      MaximumLikelihoodOptions options;
      options.estimate_time_offset = true;
      const Recording recording =
          record(truth, free_hand, count, tracker_and_camera(), seed, 0.003);
      const auto found = maximum_likelihood(recording.observations, options);
      ASSERT_TRUE(found);
      const Vector6d error =
          synthetic::error_of(found->solution.hand_from_eye, truth.solution.hand_from_eye);
      EXPECT_LT(deg_from_rad(error.head<3>().norm()), 0.1) << count << " seed " << seed;
      EXPECT_LT(error.tail<3>().norm(), 0.7) << count << " seed " << seed;
      // The hand of t + 3 ms was taken for the eye of t: stamps read 3 ms early, hands come late.
      EXPECT_NEAR(found->time_offset_correction_s, 0.003, 0.001) << count << " seed " << seed;
      EXPECT_LT(found->time_offset_sigma_s, 0.0005);
      EXPECT_NEAR(found->solution.scale_units_per_mm / 0.0123, 1.0, 0.02);
    }
  }
}

/// Mean of N chi-square variables of 6 degrees of freedom: its 99.9 % band.
struct Band {
  double low, high;
};
Band nees_band(int n) {
  const double sigma = std::sqrt(2.0 * 6 / n);
  return {6 - 3.29 * sigma, 6 + 3.29 * sigma};
}

double mean_nees(int seeds, int count, const MaximumLikelihoodOptions& options,
                 double time_offset_error_s, double eye_correlation) {
  const Truth truth = scope(0.5);
  double sum = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    const Recording recording =
        record(truth, free_hand, count, tracker_and_camera(), static_cast<std::uint32_t>(seed),
               time_offset_error_s, eye_correlation);
    const auto found = maximum_likelihood(recording.observations, options);
    if (!found) return std::numeric_limits<double>::infinity();
    sum += nees(*found, truth);
  }
  return sum / seeds;
}

TEST(MaximumLikelihood, ClaimsAnHonestCovarianceWithEstimatedNoiseAndTimeOffset) {
  MaximumLikelihoodOptions options;
  options.noise = {rad_from_deg(0.12), 0.3, rad_from_deg(0.01), 0.05};  // wrong on purpose
  options.estimate_time_offset = true;
  const double mean = mean_nees(100, 200, options, 0.001, 0);
  RecordProperty("nees", std::to_string(mean));
  EXPECT_GT(mean, nees_band(100).low);
  EXPECT_LT(mean, nees_band(100).high);
}

/// Errors of a reconstruction drift: as if there were fewer poses, which the residuals show.
TEST(MaximumLikelihood, ClaimsLessWhenErrorsAreCorrelated) {
  for (const double correlation : {0.7, 0.9}) {
    MaximumLikelihoodOptions options;
    options.noise = tracker_and_camera();
    const double honest = mean_nees(20, 300, options, 0, correlation);
    EXPECT_GT(honest, 2.0) << correlation;
    EXPECT_LT(honest, 12.0) << correlation;
    options.account_for_correlation = false;
    EXPECT_GT(mean_nees(20, 300, options, 0, correlation), honest) << correlation;
  }
}

TEST(MaximumLikelihood, FindsTheNoise) {
  MaximumLikelihoodOptions options;
  options.noise = {rad_from_deg(0.2), 0.05, rad_from_deg(0.01), 0.05};
  const Recording recording = record(scope(), free_hand, 500, tracker_and_camera(), 3);
  const auto found = maximum_likelihood(recording.observations, options);
  ASSERT_TRUE(found);
  EXPECT_NEAR(deg_from_rad(found->noise.hand_rotation_rad), 0.06, 0.006);
  EXPECT_NEAR(deg_from_rad(found->noise.eye_rotation_rad), 0.03, 0.006);
  EXPECT_NEAR(std::hypot(found->noise.hand_translation_mm, found->noise.eye_translation_mm),
              std::hypot(0.15, 0.1), 0.02);
}

TEST(MaximumLikelihood, SurvivesOutliers) {
  const Truth truth = scope();
  Recording recording = record(truth, free_hand, 300, tracker_and_camera(), 4);
  for (std::size_t k = 5; k < recording.observations.size(); k += 15) {
    recording.observations[k].poses.eye_from_scene.translation() += Eigen::Vector3d(20, -30, 10);
  }
  const auto found = maximum_likelihood(recording.observations);
  ASSERT_TRUE(found);
  const Vector6d error =
      synthetic::error_of(found->solution.hand_from_eye, truth.solution.hand_from_eye);
  EXPECT_LT(deg_from_rad(error.head<3>().norm()), 0.1);
  EXPECT_LT(error.tail<3>().norm(), 1.0);
}

TEST(MaximumLikelihood, SaysThatItDoesNotKnowOnAPivot) {
  const Recording recording = record(scope(), synthetic::pivot, 300, tracker_and_camera(), 5);
  const auto found = maximum_likelihood(recording.observations);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->covariance.allFinite());
  EXPECT_GT(found->log_scale_sigma, 0.05);
  EXPECT_GT(found->sigma_translation_mm(), 5.0);
}

TEST(MaximumLikelihood, IsTheSameEveryTime) {
  MaximumLikelihoodOptions options;
  options.estimate_time_offset = true;
  const Recording recording = record(scope(), free_hand, 200, tracker_and_camera(), 6, 0.002);
  const auto a = maximum_likelihood(recording.observations, options);
  const auto b = maximum_likelihood(recording.observations, options);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->solution.hand_from_eye.matrix(), b->solution.hand_from_eye.matrix());
  EXPECT_EQ(a->covariance, b->covariance);
}

TEST(MaximumLikelihood, GivesNothingOnUnusableData) {
  EXPECT_FALSE(maximum_likelihood({}));
  EXPECT_FALSE(maximum_likelihood({}, HandEyeSolution{}));
  Recording recording = record(scope(), free_hand, 20, tracker_and_camera(), 7);
  EXPECT_TRUE(maximum_likelihood(recording.observations, scope().solution));
  for (const double sigma : {0.0, -0.1, std::numeric_limits<double>::quiet_NaN()}) {
    const PoseNoise noise{sigma, 0.1, 0.001, 0.1};
    EXPECT_FALSE(maximum_likelihood(recording.observations, scope().solution, {.noise = noise}));
    EXPECT_FALSE(maximum_likelihood(recording.observations, {.noise = noise}));
  }
  recording.observations[3].poses.eye_from_scene.translation().x() =
      std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(maximum_likelihood(recording.observations, scope().solution));
}

TEST(MaximumLikelihood, HoldsAKnownScale) {
  const Truth truth = scope();
  const Recording recording = record(truth, synthetic::pivot, 200, tracker_and_camera(), 8);
  MaximumLikelihoodOptions options;
  options.estimate_scale = false;
  const auto found = maximum_likelihood(recording.observations, truth.solution, options);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->solution.scale_units_per_mm, 1.0);
  const Vector6d error =
      synthetic::error_of(found->solution.hand_from_eye, truth.solution.hand_from_eye);
  EXPECT_LT(error.tail<3>().norm(), 0.7);
}

TEST(MaximumLikelihood, FreesTheScaleOfTheRealViconPoses) {
  const auto poses = synthetic::real_poses("vicon_primesense.csv");
  if (poses.empty()) GTEST_SKIP() << "no poses/vicon_primesense.csv";
  const auto found = maximum_likelihood(observed(poses));
  ASSERT_TRUE(found);
  RecordProperty("scale", std::to_string(found->solution.scale_units_per_mm));
  EXPECT_GT(found->solution.scale_units_per_mm, 0.97);
  EXPECT_LT(found->solution.scale_units_per_mm, 1.01);
}

TEST(MaximumLikelihood, FreesTheScaleOfTheRealRobotPoses) {
  const auto poses = synthetic::real_poses("moveit.csv");
  if (poses.empty()) GTEST_SKIP() << "no poses/moveit.csv";
  const auto found = maximum_likelihood(observed(poses));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->solution.scale_units_per_mm, 1.0, 0.01);
  const Residuals residuals = seed_residuals(poses, found->solution);
  EXPECT_LT(residuals.rotation_deg, 0.2);
  EXPECT_LT(residuals.translation_percent, 5.0);
}

}  // namespace
}  // namespace handeye
