// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/methods/methods.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "daemon/handeye/selection.hpp"
#include "tests/unit/handeye/synthetic.hpp"

namespace handeye {
namespace {

using synthetic::all_movements;
using synthetic::random_poses;
using synthetic::random_truth;
using synthetic::Truth;

/// Those that solve from movements alone.
std::span<const Method> movement_methods() {
  return methods(ScaleMode::kUnknown).first(2);
}

void expect_exact(const HandEyeSolution& found, const Truth& truth, const std::string& what) {
  const HandEyeSolution& wanted = truth.solution;
  EXPECT_LT(rotation_angle_rad(found.hand_from_eye.linear(), wanted.hand_from_eye.linear()), 1e-9)
      << what;
  EXPECT_LT((found.hand_from_eye.translation() - wanted.hand_from_eye.translation()).norm(),
            1e-8 * wanted.hand_from_eye.translation().norm())
      << what;
  EXPECT_NEAR(found.scale_units_per_mm / wanted.scale_units_per_mm, 1.0, 1e-8) << what;
}

TEST(Methods, AreExactOnExactDataWhateverTheScale) {
  std::mt19937 generator(1);
  for (const Method& method : movement_methods()) {
    for (int trial = 0; trial < 200; ++trial) {
      const double scale = std::pow(10.0, -6 + 12 * (trial / 199.0));
      const Truth truth = random_truth(generator, scale);
      const auto poses = random_poses(truth, generator, 4 + trial % 8, rad_from_deg(60));
      const auto found = method.solve({.movements = all_movements(poses)});
      ASSERT_TRUE(found) << method.name << " trial " << trial;
      expect_exact(*found, truth, std::string(method.name) + " scale " + std::to_string(scale));
    }
  }
}

TEST(Methods, AreExactOnSmallAndOnLargeRotations) {
  std::mt19937 generator(2);
  for (const Method& method : movement_methods()) {
    for (const double angle_deg : {8.0, 30.0, 120.0, 180.0}) {
      const Truth truth = random_truth(generator, 0.013);
      const auto poses = random_poses(truth, generator, 30, rad_from_deg(angle_deg));
      const auto found = method.solve({.movements = select_movements(poses).movements});
      ASSERT_TRUE(found) << method.name << " " << angle_deg;
      expect_exact(*found, truth, std::string(method.name) + " " + std::to_string(angle_deg));
    }
  }
}

/// Movements of nearly half a turn, where the quaternions of hand and eye may come with either
/// sign.
TEST(Methods, AreExactNearHalfATurn) {
  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  for (const Method& method : movement_methods()) {
    for (const double short_of_rad : {1e-2, 1e-5, 1e-9}) {
      const Truth truth = random_truth(generator, 2.5);
      std::vector<Movement> movements;
      for (int k = 0; k < 10; ++k) {
        const Eigen::Vector3d axis =
            Eigen::Vector3d(normal(generator), normal(generator), normal(generator)).normalized();
        const double angle = k % 2 ? kPi - short_of_rad : kPi + short_of_rad;
        Movement movement;
        movement.hand_j_from_hand_i.linear() = exp_so3(angle * axis);
        movement.hand_j_from_hand_i.translation() =
            100 * Eigen::Vector3d(normal(generator), normal(generator), normal(generator));
        movement.eye_j_from_eye_i = truth.solution.hand_from_eye.inverse() *
                                    movement.hand_j_from_hand_i * truth.solution.hand_from_eye;
        movement.eye_j_from_eye_i.translation() *= truth.solution.scale_units_per_mm;
        movements.push_back(movement);
      }
      const auto found = method.solve({.movements = movements});
      ASSERT_TRUE(found) << method.name;
      expect_exact(*found, truth, std::string(method.name) + " " + std::to_string(short_of_rad));
    }
  }
}

TEST(Methods, DoNotDependOnTheUnitOfTheScene) {
  const synthetic::Recording recording = synthetic::record(synthetic::scope(), synthetic::free_hand,
                                                           150, synthetic::tracker_and_camera(), 4);
  auto poses = recording.poses();
  const auto movements = select_movements(poses).movements;
  for (const Method& method : movement_methods()) {
    const auto plain = method.solve({.movements = movements});
    ASSERT_TRUE(plain);
    for (const double factor : {1e-6, 1e6}) {
      auto scaled = movements;
      for (Movement& movement : scaled) movement.eye_j_from_eye_i.translation() *= factor;
      const auto found = method.solve({.movements = scaled});
      ASSERT_TRUE(found);
      expect_exact({found->hand_from_eye, found->scale_units_per_mm / factor}, {*plain, {}},
                   std::string(method.name));
    }
  }
}

TEST(Methods, StayNearTheTruthUnderNoise) {
  for (const Method& method : movement_methods()) {
    for (std::uint32_t seed = 0; seed < 10; ++seed) {
      const Truth truth = synthetic::scope(0.02);
      const synthetic::Recording recording = synthetic::record(
          truth, synthetic::free_hand, 300, synthetic::tracker_and_camera(), seed);
      const auto found = method.solve({.movements = select_movements(recording.poses()).movements});
      ASSERT_TRUE(found);
      const Vector6d error =
          synthetic::error_of(found->hand_from_eye, truth.solution.hand_from_eye);
      EXPECT_LT(deg_from_rad(error.head<3>().norm()), 0.3) << method.name;
      EXPECT_LT(error.tail<3>().norm(), 5.0) << method.name;
      EXPECT_NEAR(found->scale_units_per_mm / 0.02, 1.0, 0.05) << method.name;
    }
  }
}

/// Every solver must say nothing rather than anything.
void expect_nothing(const std::vector<Movement>& movements, const std::string& what) {
  for (const Method& method : movement_methods()) {
    EXPECT_FALSE(method.solve({.movements = movements})) << method.name << ": " << what;
  }
}

std::vector<Movement> exact_movements(const synthetic::Motion& motion) {
  return all_movements(
      synthetic::record(synthetic::scope(0.1), motion, 40, {0, 0, 0, 0}, 5).poses());
}

TEST(Methods, GiveNothingOnDegenerateData) {
  expect_nothing({}, "no movement");
  const std::vector<Movement> good = exact_movements(synthetic::free_hand);
  expect_nothing({good.front()}, "one movement");
  expect_nothing(std::vector<Movement>(10), "identical poses");
  expect_nothing(exact_movements(synthetic::still), "still");
  expect_nothing(exact_movements(synthetic::translation_only), "pure translation");
  expect_nothing(exact_movements(synthetic::one_axis), "parallel axes");
  expect_nothing(exact_movements(synthetic::pivot), "fixed point");
  std::vector<Movement> broken = good;
  broken[7].eye_j_from_eye_i.translation().y() = std::numeric_limits<double>::quiet_NaN();
  expect_nothing(broken, "NaN");
  broken = good;
  broken[3].hand_j_from_hand_i.matrix()(0, 0) = std::numeric_limits<double>::infinity();
  expect_nothing(broken, "infinity");
}

TEST(Methods, SolveTheRealRobotPosesNearHalfATurn) {
  const auto poses = synthetic::real_poses("moveit.csv");
  if (poses.empty()) GTEST_SKIP() << "no poses/moveit.csv";
  for (const Method& method : movement_methods()) {
    const auto found = method.solve({.movements = select_movements(poses).movements});
    ASSERT_TRUE(found) << method.name;
    EXPECT_NEAR(found->scale_units_per_mm, 1.0, 0.02) << method.name;
    const Residuals residuals = seed_residuals(poses, *found);
    EXPECT_LT(residuals.rotation_deg, 0.3) << method.name;
    EXPECT_LT(residuals.translation_percent, 5.0) << method.name;
  }
}

}  // namespace
}  // namespace handeye
