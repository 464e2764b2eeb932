// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <limits>

#include <Eigen/Dense>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/unit/handeye/synthetic.hpp"

/// The covariance against the errors made: normalised estimation error squared, 6 on average.
namespace handeye {
namespace {

constexpr int kSeeds = 500;
constexpr int kPoses = 100;

/// Mean over the seeds 0 to 499, and the band of the mean of so many chi-square variables of 6
/// degrees of freedom that chance leaves once in a thousand.
double mean_nees(const MaximumLikelihoodOptions& options, double scale_units_per_mm) {
  const synthetic::Truth truth = synthetic::scope(scale_units_per_mm);
  double sum = 0;
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    const auto recording = synthetic::record(truth, synthetic::free_hand, kPoses,
                                             synthetic::tracker_and_camera(), seed);
    const auto found = maximum_likelihood(recording.observations, options);
    if (!found) return std::numeric_limits<double>::infinity();
    const Vector6d error =
        synthetic::error_of(found->solution.hand_from_eye, truth.solution.hand_from_eye);
    sum += error.dot(found->covariance.ldlt().solve(error));
  }
  return sum / kSeeds;
}

void expect_within_band(double mean) {
  const double sigma = std::sqrt(2.0 * 6 / kSeeds);
  fmt::print("mean NEES {:.3f}, band {:.3f} to {:.3f}\n", mean, 6 - 3.29 * sigma, 6 + 3.29 * sigma);
  EXPECT_GT(mean, 6 - 3.29 * sigma);
  EXPECT_LT(mean, 6 + 3.29 * sigma);
}

MaximumLikelihoodOptions noise_given() {
  return {.noise = synthetic::tracker_and_camera(), .estimate_noise = false};
}

TEST(LikelihoodCovariance, IsHonestWithKnownScaleAndNoise) {
  MaximumLikelihoodOptions options = noise_given();
  options.estimate_scale = false;
  expect_within_band(mean_nees(options, 1.0));
}

TEST(LikelihoodCovariance, IsHonestWithUnknownScaleAndKnownNoise) {
  expect_within_band(mean_nees(noise_given(), 0.5));
}

TEST(LikelihoodCovariance, IsHonestWithKnownScaleAndEstimatedNoise) {
  MaximumLikelihoodOptions options;
  options.estimate_scale = false;
  expect_within_band(mean_nees(options, 1.0));
}

TEST(LikelihoodCovariance, IsHonestWithUnknownScaleAndEstimatedNoise) {
  expect_within_band(mean_nees({}, 0.5));
}

}  // namespace
}  // namespace handeye
