// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/methods/methods.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "daemon/handeye/selection.hpp"
#include "tests/unit/handeye/synthetic.hpp"

/// What every row of both tables keeps. Exactness over random configurations: exactness_test.cpp.
namespace handeye {
namespace {

using synthetic::all_movements;
using synthetic::random_poses;
using synthetic::random_truth;
using synthetic::Truth;

constexpr std::array<ScaleMode, 2> kModes{ScaleMode::kKnown, ScaleMode::kUnknown};

/// Those that solve from movements alone: all but the last.
std::span<const Method> movement_methods(ScaleMode mode) {
  const std::span<const Method> all = methods(mode);
  return all.first(all.size() - 1);
}

std::string label(const Method& method, ScaleMode mode) {
  return std::string(method.name) + (mode == ScaleMode::kKnown ? ", known" : ", unknown");
}

double scale_in(ScaleMode mode, double units_per_mm) {
  return mode == ScaleMode::kKnown ? 1.0 : units_per_mm;
}

void expect_near(const HandEyeSolution& found, const HandEyeSolution& wanted, double tolerance,
                 const std::string& what) {
  EXPECT_LT(rotation_angle_rad(found.hand_from_eye.linear(), wanted.hand_from_eye.linear()),
            0.1 * tolerance)
      << what;
  EXPECT_LT((found.hand_from_eye.translation() - wanted.hand_from_eye.translation()).norm(),
            tolerance * wanted.hand_from_eye.translation().norm())
      << what;
  EXPECT_NEAR(found.scale_units_per_mm / wanted.scale_units_per_mm, 1.0, tolerance) << what;
}

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

/// Every solver must say nothing rather than anything.
void expect_nothing(ScaleMode mode, const std::vector<PosePair>& poses,
                    const std::vector<Movement>& movements, const std::string& what) {
  for (const Method& method : methods(mode)) {
    EXPECT_FALSE(method.solve({.poses = poses, .movements = movements}))
        << label(method, mode) << ": " << what;
  }
}

void expect_nothing(ScaleMode mode, const std::vector<PosePair>& poses, const std::string& what) {
  expect_nothing(mode, poses, all_movements(poses), what);
}

std::vector<PosePair> exact_poses(ScaleMode mode, const synthetic::Motion& motion) {
  return synthetic::record(synthetic::scope(scale_in(mode, 0.1)), motion, 40, {0, 0, 0, 0}, 5)
      .poses();
}

TEST(Methods, GiveNothingOnDegenerateMotion) {
  for (const ScaleMode mode : kModes) {
    expect_nothing(mode, {}, "no pose");
    const std::vector<PosePair> good = exact_poses(mode, synthetic::free_hand);
    expect_nothing(mode, {good.front()}, "one pose");
    expect_nothing(mode, {good[0], good[20]}, "one movement");
    expect_nothing(mode, std::vector<PosePair>(10, good.front()), "identical poses");
    expect_nothing(mode, exact_poses(mode, synthetic::still), "still");
    expect_nothing(mode, exact_poses(mode, synthetic::translation_only), "pure translation");
    expect_nothing(mode, exact_poses(mode, synthetic::one_axis), "parallel axes");
  }
}

/// The likelihood gives an answer with the covariance it has, which the judge refuses (judge_test).
TEST(Methods, FromMovementsGiveNothingOnAFixedPointWithUnknownScale) {
  const auto movements = all_movements(exact_poses(ScaleMode::kUnknown, synthetic::pivot));
  for (const Method& method : movement_methods(ScaleMode::kUnknown)) {
    EXPECT_FALSE(method.solve({.movements = movements})) << method.name;
  }
}

TEST(Methods, GiveNothingOnNumbersThatAreNoPoses) {
  for (const ScaleMode mode : kModes) {
    const std::vector<PosePair> good = exact_poses(mode, synthetic::free_hand);
    const auto expect_refused = [&](const std::string& what, auto spoil) {
      std::vector<PosePair> broken = good;
      spoil(broken[7]);
      expect_nothing(mode, broken, what);
    };
    expect_refused("NaN", [](PosePair& pair) {
      pair.eye_from_scene.translation().y() = std::numeric_limits<double>::quiet_NaN();
    });
    expect_refused("infinity", [](PosePair& pair) {
      pair.room_from_hand.matrix()(0, 0) = std::numeric_limits<double>::infinity();
    });
    expect_refused("zero matrix", [](PosePair& pair) { pair.room_from_hand.linear().setZero(); });
    expect_refused("scaled rotation", [](PosePair& pair) { pair.eye_from_scene.linear() *= 1.01; });
    expect_refused("sheared rotation",
                   [](PosePair& pair) { pair.room_from_hand.linear()(0, 1) += 1e-3; });
    expect_refused("mirrored rotation",
                   [](PosePair& pair) { pair.eye_from_scene.linear().col(2) *= -1.0; });
  }
}

TEST(Methods, WithKnownScaleSolveAFixedPoint) {
  const Truth truth = synthetic::scope();
  const auto poses = exact_poses(ScaleMode::kKnown, synthetic::pivot);
  const auto movements = all_movements(poses);
  for (const Method& method : methods(ScaleMode::kKnown)) {
    const auto found = method.solve({.poses = poses, .movements = movements});
    ASSERT_TRUE(found) << method.name;
    expect_near(*found, truth.solution, 1e-8, std::string(method.name));
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
