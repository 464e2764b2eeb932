// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/methods/methods.hpp"

#include <cmath>
#include <random>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "daemon/handeye/selection.hpp"
#include "tests/unit/handeye/synthetic.hpp"
#include "tests/unit/handeye/tables.hpp"

/// What every row of both tables keeps. Exactness over random configurations:
/// exactness_test.cpp; input that determines nothing: degenerate_test.cpp.
namespace handeye {
namespace {

using synthetic::random_poses;
using synthetic::random_truth;
using synthetic::Truth;

using tables::expect_near;
using tables::kModes;
using tables::label;
using tables::movement_methods;
using tables::scale_in;

TEST(Methods, AreNamedOnceInEachTableAndEndWithTheAnswer) {
  for (const ScaleMode mode : kModes) {
    std::set<std::string_view> names;
    for (const Method& method : methods(mode)) {
      EXPECT_TRUE(names.insert(method.name).second) << method.name;
      EXPECT_FALSE(method.source.empty()) << method.name;
    }
    EXPECT_EQ(methods(mode).back().name, "maximum_likelihood");
  }
}

TEST(Methods, AreExactOnSmallAndOnLargeRotations) {
  std::mt19937 generator(2);
  for (const ScaleMode mode : kModes) {
    for (const double angle_deg : {8.0, 30.0, 120.0, 180.0}) {
      const Truth truth = random_truth(generator, scale_in(mode, 0.013));
      const auto poses = random_poses(truth, generator, 30, rad_from_deg(angle_deg));
      const auto movements = select_movements(poses).movements;
      for (const Method& method : methods(mode)) {
        const auto found = method.solve({.poses = poses, .movements = movements});
        ASSERT_TRUE(found) << label(method, mode) << " " << angle_deg;
        expect_near(*found, truth.solution, 1e-8,
                    label(method, mode) + " " + std::to_string(angle_deg));
      }
    }
  }
}

/// Ten movements of nearly half a turn about any axes, half of them beyond it. The quaternions of
/// hand and eye may come with either sign, and with noise on either side.
std::vector<Movement> half_turns(const Truth& truth, double short_of_rad, const PoseNoise& noise,
                                 std::mt19937& generator) {
  std::normal_distribution<double> normal;
  const auto normal3 = [&] {
    const double x = normal(generator);
    const double y = normal(generator);
    return Eigen::Vector3d(x, y, normal(generator));
  };
  std::vector<Movement> movements;
  for (int k = 0; k < 10; ++k) {
    const double angle = k % 2 ? kPi - short_of_rad : kPi + short_of_rad;
    Movement movement;
    auto& [hand, eye] = movement;
    hand.linear() = exp_so3(angle * normal3().normalized());
    hand.translation() = 100 * normal3();
    eye = truth.solution.hand_from_eye.inverse() * hand * truth.solution.hand_from_eye;
    hand.linear() = hand.linear() * exp_so3(noise.hand_rotation_rad * normal3());
    hand.translation() += noise.hand_translation_mm * normal3();
    eye.linear() = eye.linear() * exp_so3(noise.eye_rotation_rad * normal3());
    eye.translation() += noise.eye_translation_mm * normal3();
    eye.translation() *= truth.solution.scale_units_per_mm;
    movements.push_back(movement);
  }
  return movements;
}

TEST(Methods, AreExactNearHalfATurn) {
  std::mt19937 generator(3);
  for (const ScaleMode mode : kModes) {
    for (const double short_of_rad : {1e-2, 1e-5, 1e-9}) {
      const Truth truth = random_truth(generator, scale_in(mode, 2.5));
      const auto movements = half_turns(truth, short_of_rad, {0, 0, 0, 0}, generator);
      for (const Method& method : movement_methods(mode)) {
        const auto found = method.solve({.movements = movements});
        ASSERT_TRUE(found) << label(method, mode);
        expect_near(*found, truth.solution, 1e-8,
                    label(method, mode) + " " + std::to_string(short_of_rad));
      }
    }
  }
}

TEST(Methods, StayNearTheTruthUnderNoiseNearHalfATurn) {
  std::mt19937 generator(4);
  for (const ScaleMode mode : kModes) {
    for (int trial = 0; trial < 50; ++trial) {
      const Truth truth = random_truth(generator, scale_in(mode, 0.4));
      const auto movements =
          half_turns(truth, 1e-3, {rad_from_deg(0.1), 0.2, rad_from_deg(0.1), 0.2}, generator);
      for (const Method& method : movement_methods(mode)) {
        const auto found = method.solve({.movements = movements});
        ASSERT_TRUE(found) << label(method, mode) << " trial " << trial;
        const Vector6d error =
            synthetic::error_of(found->hand_from_eye, truth.solution.hand_from_eye);
        EXPECT_LT(deg_from_rad(error.head<3>().norm()), 0.5) << label(method, mode);
        EXPECT_LT(error.tail<3>().norm(), 3.0) << label(method, mode);
      }
    }
  }
}

TEST(Methods, DoNotDependOnTheUnitOfTheScene) {
  const synthetic::Recording recording = synthetic::record(synthetic::scope(), synthetic::free_hand,
                                                           150, synthetic::tracker_and_camera(), 4);
  const auto poses = recording.poses();
  const auto movements = select_movements(poses).movements;
  for (const Method& method : movement_methods(ScaleMode::kUnknown)) {
    const auto plain = method.solve({.movements = movements});
    ASSERT_TRUE(plain) << method.name;
    for (const double factor : {1e-6, 1e6}) {
      auto scaled = movements;
      for (Movement& movement : scaled) movement.eye_j_from_eye_i.translation() *= factor;
      const auto found = method.solve({.movements = scaled});
      ASSERT_TRUE(found) << method.name;
      expect_near({found->hand_from_eye, found->scale_units_per_mm / factor}, *plain, 1e-6,
                  std::string(method.name));
    }
  }
}

TEST(Methods, WithKnownScaleDoNotDependOnTheUnitOfLength) {
  const synthetic::Recording recording = synthetic::record(synthetic::scope(), synthetic::free_hand,
                                                           150, synthetic::tracker_and_camera(), 4);
  const auto movements = select_movements(recording.poses()).movements;
  for (const Method& method : movement_methods(ScaleMode::kKnown)) {
    if (method.name == "horaud_nonlinear") continue;  // as printed, it adds rad^2 to mm^2
    const auto plain = method.solve({.movements = movements});
    ASSERT_TRUE(plain) << method.name;
    auto in_metres = movements;
    for (auto& [hand, eye] : in_metres) {
      hand.translation() *= 1e-3;
      eye.translation() *= 1e-3;
    }
    auto found = method.solve({.movements = in_metres});
    ASSERT_TRUE(found) << method.name;
    found->hand_from_eye.translation() *= 1e3;
    expect_near(*found, *plain, 1e-8, std::string(method.name));
  }
}

TEST(Methods, StayNearTheTruthUnderNoise) {
  for (const ScaleMode mode : kModes) {
    const double scale = scale_in(mode, 0.02);
    for (std::uint32_t seed = 0; seed < 10; ++seed) {
      const Truth truth = synthetic::scope(scale);
      const auto poses =
          synthetic::record(truth, synthetic::free_hand, 300, synthetic::tracker_and_camera(), seed)
              .poses();
      const auto movements = select_movements(poses).movements;
      for (const Method& method : methods(mode)) {
        const auto found = method.solve({.poses = poses, .movements = movements});
        ASSERT_TRUE(found) << label(method, mode);
        const Vector6d error =
            synthetic::error_of(found->hand_from_eye, truth.solution.hand_from_eye);
        EXPECT_LT(deg_from_rad(error.head<3>().norm()), 0.3) << label(method, mode);
        EXPECT_LT(error.tail<3>().norm(), 5.0) << label(method, mode);
        EXPECT_NEAR(found->scale_units_per_mm / scale, 1.0, 0.05) << label(method, mode);
      }
    }
  }
}

TEST(Methods, SolveTheRealRobotPosesNearHalfATurn) {
  const auto poses = synthetic::real_poses("moveit.csv");
  if (poses.empty()) GTEST_SKIP() << "no poses/moveit.csv";
  const auto movements = select_movements(poses).movements;
  for (const ScaleMode mode : kModes) {
    for (const Method& method : methods(mode)) {
      const auto found = method.solve({.poses = poses, .movements = movements});
      ASSERT_TRUE(found) << label(method, mode);
      EXPECT_NEAR(found->scale_units_per_mm, 1.0, 0.02) << label(method, mode);
      const Residuals residuals = seed_residuals(poses, *found);
      EXPECT_LT(residuals.rotation_deg, 0.3) << label(method, mode);
      EXPECT_LT(residuals.translation_percent, 5.0) << label(method, mode);
    }
  }
}

}  // namespace
}  // namespace handeye
