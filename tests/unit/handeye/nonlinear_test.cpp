// SPDX-License-Identifier: BSD-3-Clause
// The methods that minimise the paper's non-linear functions.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include <gtest/gtest.h>

#include "daemon/handeye/methods/methods.hpp"
#include "tests/unit/handeye/nonlinear_scenes.hpp"
#include "tests/unit/handeye/synthetic.hpp"

namespace handeye {
namespace {

using synthetic::noisy_movements;
using synthetic::Random;
using synthetic::random_solution;

struct Candidate {
  std::string_view name;
  Solver solve;
  bool known_scale;
};
constexpr std::array<Candidate, 4> kMethods{{
    {"horaud_nonlinear", horaud_nonlinear, true},
    {"horaud_scale_separate", horaud_scale_separate, false},
    {"nonlinear_quaternion", nonlinear_quaternion, false},
    {"nonlinear_dual_quaternion", nonlinear_dual_quaternion, false},
}};

double mean_hand_mm(const std::vector<Movement>& movements) {
  double sum = 0;
  for (const Movement& movement : movements)
    sum += movement.hand_j_from_hand_i.translation().norm();
  return sum / static_cast<double>(movements.size());
}

TEST(Nonlinear, MethodsAreExactOnExactData) {
  Random random(3);
  for (const auto& [name, solve, known_scale] : kMethods) {
    int solved = 0;
    double worst_rad = 0;
    double worst_translation = 0;
    double worst_scale = 0;
    for (int trial = 0; trial < 250; ++trial) {
      const double scale = known_scale ? 1.0 : random.power_of_ten(-6, 6);
      const HandEyeSolution truth = random_solution(random, random.power_of_ten(1, 3.5), scale);
      const auto movements = synthetic::random_movements(truth, random, trial);
      if (!(synthetic::condition_of(movements, truth) < 1e3)) continue;
      const auto found = solve({.movements = movements});
      ASSERT_TRUE(found) << name << " trial " << trial;
      const Vector6d error = synthetic::error_of(found->hand_from_eye, truth.hand_from_eye);
      const double length =
          std::max(truth.hand_from_eye.translation().norm(), mean_hand_mm(movements));
      worst_rad = std::max(worst_rad, error.head<3>().norm());
      worst_translation = std::max(worst_translation, error.tail<3>().norm() / length);
      worst_scale = std::max(worst_scale, std::abs(found->scale_units_per_mm / scale - 1));
      ++solved;
    }
    EXPECT_GT(solved, 200) << name;
    EXPECT_LT(worst_rad, 1e-9) << name;
    EXPECT_LT(worst_translation, 1e-8) << name;
    EXPECT_LT(worst_scale, 1e-10) << name;
  }
}

TEST(Nonlinear, DoesNotDependOnTheUnitOfTheScene) {
  for (const auto& [name, solve, known_scale] : kMethods) {
    if (known_scale) continue;
    for (std::uint32_t seed = 0; seed < 5; ++seed) {
      const auto movements = noisy_movements(0.02, seed);
      const auto plain = solve({.movements = movements});
      ASSERT_TRUE(plain) << name;
      for (const double factor : {1e-6, 1e-3, 3.0, 1e6}) {
        auto scaled = movements;
        for (Movement& movement : scaled) movement.eye_j_from_eye_i.translation() *= factor;
        const auto found = solve({.movements = scaled});
        ASSERT_TRUE(found) << name;
        const Vector6d error = synthetic::error_of(found->hand_from_eye, plain->hand_from_eye);
        const double length = plain->hand_from_eye.translation().norm();
        EXPECT_LT(error.head<3>().norm(), 1e-8) << name << factor;
        EXPECT_LT(error.tail<3>().norm(), 1e-8 * length) << name << factor;
        EXPECT_NEAR(found->scale_units_per_mm / factor / plain->scale_units_per_mm, 1, 1e-8)
            << name << factor;
      }
    }
  }
}

/// Turns of half a circle, give or take a millirad, with the noise of tracker and camera.
TEST(Nonlinear, StaysNearTheTruthUnderNoiseNearHalfATurn) {
  Random random(4);
  for (const auto& [name, solve, known_scale] : kMethods) {
    for (int trial = 0; trial < 20; ++trial) {
      const HandEyeSolution truth = random_solution(random, 100, known_scale ? 1.0 : 0.02);
      std::vector<Movement> movements;
      for (int k = 0; k < 40; ++k) {
        Movement movement =
            synthetic::exact_movement(truth, random, kPi + 1e-3 * random.normal(), 100);
        auto& [hand, eye] = movement;
        hand.linear() = hand.linear() * exp_so3(1e-3 * random.normal3());
        hand.translation() += 0.15 * random.normal3();
        eye.linear() = eye.linear() * exp_so3(5e-4 * random.normal3());
        eye.translation() += 0.1 * truth.scale_units_per_mm * random.normal3();
        movements.push_back(movement);
      }
      const auto found = solve({.movements = movements});
      ASSERT_TRUE(found) << name;
      const Vector6d error = synthetic::error_of(found->hand_from_eye, truth.hand_from_eye);
      EXPECT_LT(deg_from_rad(error.head<3>().norm()), 0.1) << name;
      EXPECT_LT(error.tail<3>().norm(), 1.0) << name;
      EXPECT_NEAR(found->scale_units_per_mm / truth.scale_units_per_mm, 1, 0.005) << name;
    }
  }
}

TEST(Nonlinear, HoraudStaysNearTheTruthUnderNoise) {
  const synthetic::Truth truth = synthetic::scope();
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    const auto found = horaud_nonlinear({.movements = noisy_movements(1.0, seed)});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->scale_units_per_mm, 1.0);
    const Vector6d error = synthetic::error_of(found->hand_from_eye, truth.solution.hand_from_eye);
    EXPECT_LT(deg_from_rad(error.head<3>().norm()), 0.3);
    EXPECT_LT(error.tail<3>().norm(), 3.0);
  }
}

TEST(Nonlinear, GivesNothingOnDegenerateData) {
  const auto exact = [](const synthetic::Motion& motion) {
    return synthetic::all_movements(
        synthetic::record(synthetic::scope(), motion, 40, {0, 0, 0, 0}, 5).poses());
  };
  auto not_finite = exact(synthetic::free_hand);
  not_finite[7].eye_j_from_eye_i.translation().y() = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [name, solve, known_scale] : kMethods) {
    EXPECT_TRUE(solve({.movements = exact(synthetic::free_hand)})) << name;
    EXPECT_FALSE(solve({})) << name;
    EXPECT_FALSE(solve({.movements = std::vector<Movement>(10)})) << name;
    EXPECT_FALSE(solve({.movements = exact(synthetic::translation_only)})) << name;
    EXPECT_FALSE(solve({.movements = exact(synthetic::one_axis)})) << name;
    EXPECT_FALSE(solve({.movements = not_finite})) << name;
    // With the scale known, a fixed point hides nothing.
    EXPECT_EQ(solve({.movements = exact(synthetic::pivot)}).has_value(), known_scale) << name;
  }
}

}  // namespace
}  // namespace handeye
