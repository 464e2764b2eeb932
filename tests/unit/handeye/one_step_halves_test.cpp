// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "daemon/handeye/halves.hpp"
#include "tests/unit/handeye/one_step_scenes.hpp"

/// What two halves of the data say of the whole.
namespace handeye {
namespace {

using synthetic::OneStepScene;

HalvesOfWhole halves_that_differ(const Vector6d& difference, const Matrix6d& covariance,
                                 const Matrix6d& of_whole) {
  return {{.difference = difference, .covariance = covariance}, of_whole};
}

Matrix6d some_covariance() {
  Matrix6d factor;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) factor(i, j) = (i == j ? 2.0 : 0.3) + 0.1 * i - 0.2 * j;
  }
  return factor * factor.transpose();
}

TEST(ErrorOfWhole, IsHalfTheDifferenceWhereTheWholeAddsUpItsHalves) {
  const Vector6d difference = Vector6d::LinSpaced(-1, 2);
  const Matrix6d covariance = some_covariance();
  const Vector6d error =
      halves_that_differ(difference, covariance, 0.25 * covariance).error_of_whole();
  EXPECT_LT((error - 0.5 * difference).norm(), 1e-9);
}

TEST(ErrorOfWhole, IsNeverMoreThanHalf) {
  const Vector6d difference = Vector6d::LinSpaced(-1, 2);
  const Matrix6d covariance = some_covariance();
  const Vector6d error =
      halves_that_differ(difference, covariance, 9.0 * covariance).error_of_whole();
  EXPECT_LT((error - 0.5 * difference).norm(), 1e-9);
}

TEST(ErrorOfWhole, IsLittleAlongWhatTheHalvesHardlyKnow) {
  Vector6d unit = Vector6d::Ones();
  unit[2] = 100;  // the halves' standard deviation there
  const Matrix6d covariance = unit.cwiseAbs2().asDiagonal();
  const Vector6d difference = 3 * unit;
  const Vector6d error =
      halves_that_differ(difference, covariance, 0.25 * Matrix6d::Identity()).error_of_whole();
  EXPECT_NEAR(error[0], 1.5, 1e-9);
  EXPECT_LT(error[2], 0.05);
}

/// The camera turns in its clip half-way.
std::optional<HalvesOfWhole> after_slip_of(double slip_deg, std::uint32_t seed) {
  OneStepScene scene = synthetic::one_step_scene({}, seed);
  const Eigen::Matrix3d slip = exp_so3({0, 0, rad_from_deg(slip_deg)});
  for (std::size_t k = scene.problem.frames.size() / 2; k < scene.problem.frames.size(); ++k) {
    Pose& hand = scene.problem.frames[k].hand->room_from_hand;
    hand.linear() = hand.linear() * slip;
  }
  const auto start = synthetic::start_of(scene);
  if (!start) return std::nullopt;
  const OneStepOptions options = one_step_options(scene, HandNoiseSource::kEstimated);
  const auto whole = one_step(scene.problem, *start, options);
  if (!whole) return std::nullopt;
  return compare_halves(scene.problem, *start, *whole, options);
}

TEST(OneStepHalves, AgreeUnlessTheCameraSlips) {
  for (std::uint32_t seed = 0; seed < 5; ++seed) {
    const auto without = after_slip_of(0, seed);
    const auto with = after_slip_of(2, seed);
    ASSERT_TRUE(without && with) << seed;
    EXPECT_LT(without->chi2, 27.9) << seed << ": exceeded by chance once in 10 000";
    EXPECT_GT(with->chi2, 27.9) << seed;
    EXPECT_NEAR(deg_from_rad(with->difference.head<3>().norm()), 2, 0.7) << seed;
  }
}

TEST(OneStepHalves, AreTheSameEveryTime) {
  const auto once = after_slip_of(0, 3);
  const auto again = after_slip_of(0, 3);
  ASSERT_TRUE(once && again);
  EXPECT_EQ(once->difference, again->difference);
  EXPECT_EQ(once->chi2, again->chi2);
}

}  // namespace
}  // namespace handeye
