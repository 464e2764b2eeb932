// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/factorisation.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include "daemon/reconstruction/metric_upgrade.hpp"
#include "daemon/reconstruction/perspective_alternation.hpp"
#include "tests/unit/reconstruction/synthetic_window.hpp"

namespace handeye {
namespace {

using test::WindowOptions;

/// The two reversed solutions, that with the truer rotations first.
std::pair<PerspectiveSolution, PerspectiveSolution> solve_both(
    const Eigen::MatrixXd& rays, const test::SyntheticWindow& window,
    const AlternationOptions& options = {}) {
  auto first = solve_perspective(rays, Reversal::kFirst, options);
  auto mirrored = solve_perspective(rays, Reversal::kMirrored, options);
  const auto error = [&](const PerspectiveSolution& solution) {
    return test::largest_rotation_error_deg(solution.eye_from_scene, window.eye_from_scene);
  };
  if (!mirrored.eye_from_scene.empty() && error(mirrored) < error(first)) {
    std::swap(first, mirrored);
  }
  return {first, mirrored};
}

double median_of(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

TEST(Factorisation, ReproducesMeasurementsOfRankThree) {
  const auto window = test::make_window({});
  const AffineFactorisation affine = factorise(window.affine_rays);
  const Eigen::MatrixXd again = (affine.motion * affine.shape).colwise() + affine.centroid;
  EXPECT_LT((again - window.affine_rays).norm(), 1e-10);
  EXPECT_GT(affine.sigma(2), 1e5 * affine.sigma(3));
}

TEST(Factorisation, ShowsTheNoiseInTheFourthSingularValue) {
  WindowOptions options;
  options.points = 200;
  const auto window = test::make_window(options);
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, options.noise_px / test::kWindowFocalPx);
  const Eigen::MatrixXd noisy =
      window.affine_rays.unaryExpr([&](double value) { return value + noise(random); });
  const double expected =
      options.noise_px / test::kWindowFocalPx * std::sqrt(static_cast<double>(options.points));
  EXPECT_NEAR(factorise(noisy).sigma(3) / expected, 1.0, 0.6);
}

TEST(MetricUpgrade, IsExactOnParaperspectiveImages) {
  for (const unsigned seed : {1U, 2U, 3U, 4U, 5U}) {
    WindowOptions options;
    options.seed = seed;
    options.relief = 0.3;
    const auto window = test::make_window(options);
    const auto [best, reversed] = solve_both(window.affine_rays, window, {.max_passes = 1});
    ASSERT_EQ(best.outcome, MetricOutcome::kLinear);
    EXPECT_LT(test::largest_rotation_error_deg(best.eye_from_scene, window.eye_from_scene), 1e-5);
    // The reversed scene explains the same images with other rotations.
    EXPECT_GT(test::largest_rotation_error_deg(reversed.eye_from_scene, window.eye_from_scene),
              1.0);
  }
}

TEST(MetricUpgrade, RefusesRowsThatNoCameraHas) {
  // Both rows of every frame the same: they can be neither of one length and at right angles.
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  AffineFactorisation affine;
  affine.centroid = Eigen::VectorXd::Zero(20);
  affine.motion.resize(20, 3);
  for (Eigen::Index row = 0; row < 20; row += 2) {
    affine.motion.row(row) << uniform(random), uniform(random), uniform(random);
    affine.motion.row(row + 1) = affine.motion.row(row);
  }
  EXPECT_EQ(upgrade_to_metric(affine).outcome, MetricOutcome::kIndefinite);
}

TEST(MetricUpgrade, RefusesTracksThatAreNotRigid) {
  std::mt19937 random(6);
  std::normal_distribution<double> wild(0.0, 0.2);
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::MatrixXd rays =
        Eigen::MatrixXd(30, 60).unaryExpr([&](double) { return wild(random); });
    const auto solution = solve_perspective(rays, Reversal::kFirst);
    EXPECT_EQ(solution.outcome, MetricOutcome::kIndefinite);
    EXPECT_TRUE(solution.eye_from_scene.empty());
  }
}

TEST(PerspectiveAlternation, IsExactOnPerspectiveImagesWithoutNoise) {
  for (const unsigned seed : {1U, 2U, 3U, 4U, 5U}) {
    WindowOptions options;
    options.seed = seed;
    options.relief = 0.3;
    options.sweep_deg = 20;
    options.noise_px = 0.0;
    const auto window = test::make_window(options);
    const auto [best, reversed] =
        solve_both(window.rays, window, {.max_passes = 100, .settled = 1e-10});
    ASSERT_FALSE(best.eye_from_scene.empty());
    EXPECT_TRUE(best.in_front);
    EXPECT_LT(best.error, 1e-8);
    EXPECT_LT(test::largest_rotation_error_deg(best.eye_from_scene, window.eye_from_scene), 1e-5);
    EXPECT_GT(reversed.error, 1e3 * best.error);
  }
}

struct Relief {
  double relief;
  double sweep_deg;
  double iterated_deg;  ///< median rotation error expected at most
  int good;             ///< of 100 seeds, at least
};

class AlternationFigures : public testing::TestWithParam<Relief> {};

TEST_P(AlternationFigures, Hold) {
  std::vector<double> first_deg;
  std::vector<double> iterated_deg;
  int good = 0;
  int mirror_right = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    WindowOptions options;
    options.seed = seed;
    options.relief = GetParam().relief;
    options.sweep_deg = GetParam().sweep_deg;
    const auto window = test::make_window(options);
    const auto [best, reversed] = solve_both(window.rays, window);
    if (best.eye_from_scene.empty()) continue;
    const auto single = solve_both(window.rays, window, {.max_passes = 1}).first;
    first_deg.push_back(
        test::largest_rotation_error_deg(single.eye_from_scene, window.eye_from_scene));
    iterated_deg.push_back(
        test::largest_rotation_error_deg(best.eye_from_scene, window.eye_from_scene));
    if (iterated_deg.back() < 0.25 * options.sweep_deg) ++good;
    if (best.error < reversed.error) ++mirror_right;
  }
  EXPECT_LE(median_of(iterated_deg), GetParam().iterated_deg);
  EXPECT_LT(median_of(iterated_deg), 0.2 * median_of(first_deg));
  EXPECT_GE(good, GetParam().good);
  EXPECT_GE(mirror_right, GetParam().good);
}

INSTANTIATE_TEST_SUITE_P(Reliefs, AlternationFigures,
                         testing::Values(Relief{0.4, 20, 0.25, 95}, Relief{0.15, 20, 0.3, 95},
                                         Relief{0.15, 8, 0.4, 93}, Relief{0.05, 20, 0.8, 80}));

}  // namespace
}  // namespace handeye
