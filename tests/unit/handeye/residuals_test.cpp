// SPDX-License-Identifier: BSD-3-Clause
#include <random>

#include <gtest/gtest.h>

#include "daemon/handeye/types.hpp"
#include "tests/unit/handeye/synthetic.hpp"

namespace handeye {
namespace {

TEST(Residuals, VanishAtTheTruthInAnyScale) {
  std::mt19937 generator(1);
  for (const double scale : {1e-6, 1.0, 1e6}) {
    const synthetic::Truth truth = synthetic::random_truth(generator, scale);
    const auto poses = synthetic::random_poses(truth, generator, 20, 1.0);
    const Residuals residuals = seed_residuals(poses, truth.solution);
    EXPECT_LT(residuals.rotation_deg, 1e-10);
    EXPECT_LT(residuals.rotation_percent, 1e-8);
    EXPECT_LT(residuals.translation_percent, 1e-8);
    EXPECT_LT(residuals.translation_norm_percent, 1e-8);
  }
}

TEST(Residuals, OfAWrongScaleAreThatShare) {
  std::mt19937 generator(2);
  const synthetic::Truth truth = synthetic::random_truth(generator, 3.0);
  const auto poses = synthetic::random_poses(truth, generator, 20, 1.0);
  HandEyeSolution wrong = truth.solution;
  wrong.scale_units_per_mm *= 1.1;
  const Residuals residuals = seed_residuals(poses, wrong);
  EXPECT_NEAR(residuals.translation_percent, 10.0, 1e-8);
  EXPECT_NEAR(residuals.translation_norm_percent, 10.0, 1e-8);
  EXPECT_LT(residuals.rotation_deg, 1e-10);
}

TEST(Residuals, LeaveStandstillOutOfRelativeFigures) {
  const auto poses = synthetic::record(synthetic::scope(), synthetic::still, 50,
                                       synthetic::tracker_and_camera(), 3)
                         .poses();
  const Residuals residuals = seed_residuals(poses, synthetic::scope().solution);
  EXPECT_GT(residuals.rotation_deg, 0.0);
  EXPECT_EQ(residuals.rotation_percent, 0.0);
  EXPECT_EQ(residuals.translation_percent, 0.0);
}

TEST(Residuals, OfFewerThanTwoPosesAreZero) {
  EXPECT_EQ(seed_residuals({}, {}).rotation_deg, 0.0);
}

}  // namespace
}  // namespace handeye
