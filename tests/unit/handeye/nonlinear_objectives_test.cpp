// SPDX-License-Identifier: BSD-3-Clause
// The paper's non-linear functions, eqs 7 and 15, and their minima.
#include <cmath>

#include <gtest/gtest.h>

#include "daemon/handeye/methods/dual_quaternion_objective.hpp"
#include "daemon/handeye/methods/methods.hpp"
#include "daemon/handeye/methods/quaternion_objective.hpp"
#include "daemon/handeye/selection.hpp"
#include "tests/unit/handeye/nonlinear_scenes.hpp"
#include "tests/unit/handeye/synthetic.hpp"

namespace handeye {
namespace {

using synthetic::exact_movement;
using synthetic::noisy_movements;
using synthetic::Random;
using synthetic::random_solution;
using Quaternion = Eigen::Quaterniond;

Quaternion pure(const Eigen::Vector3d& v) {
  return {0, v.x(), v.y(), v.z()};
}
Quaternion operator+(const Quaternion& a, const Quaternion& b) {
  return Quaternion(Eigen::Vector4d(a.coeffs() + b.coeffs()));
}
Quaternion operator-(const Quaternion& a, const Quaternion& b) {
  return Quaternion(Eigen::Vector4d(a.coeffs() - b.coeffs()));
}
Quaternion operator*(double factor, const Quaternion& a) {
  return Quaternion(Eigen::Vector4d(factor * a.coeffs()));
}

Quaternion true_rotation() {
  return Quaternion(synthetic::scope().solution.hand_from_eye.inverse().linear());
}

// The printed functions, term by term.

double eq7(const std::vector<Movement>& movements, const QuaternionUnknowns& x,
           const Quaternion& about) {
  double sum = 0;
  for (const auto& [hand, eye] : movements) {
    const Quaternion q_h(hand.linear());
    Quaternion q_e(eye.linear());
    if (q_e.dot(about * q_h * about.conjugate()) < 0) q_e = -1.0 * q_e;
    sum += (x.q * q_h - q_e * x.q).squaredNorm();
    const Eigen::Vector3d rest = x.t - eye.linear() * x.t - eye.translation();
    sum += (pure(rest) + x.q * pure(x.s * hand.translation()) * x.q.conjugate()).squaredNorm();
  }
  return sum + 2e6 * std::pow(1 - x.q.squaredNorm(), 2);
}

struct Eqs13And14 {
  Quaternion eq13;
  Quaternion eq14;
};
Eqs13And14 left_minus_right(const Movement& movement, const SimilarityDualQuaternion& x,
                            const Quaternion& about) {
  const auto& [hand, eye] = movement;
  const Quaternion q_h(hand.linear());
  Quaternion q_e(eye.linear());
  if (q_e.dot(about * q_h * about.conjugate()) < 0) q_e = -1.0 * q_e;
  const Quaternion q_hd = 0.5 * (pure(hand.translation()) * q_h);
  const Quaternion q_ed = 0.5 * (pure(eye.translation()) * q_e);
  const double s = std::sqrt(x.real.squaredNorm());
  return {q_e * x.real - x.real * q_h,
          (q_e * x.dual + (1 / s) * (q_ed * x.real)) - (x.real * q_hd + x.dual * q_h)};
}

double eq15(const std::vector<Movement>& movements, const SimilarityDualQuaternion& x,
            const Quaternion& about) {
  double sum = 0;
  for (const Movement& movement : movements) {
    const auto [eq13, eq14] = left_minus_right(movement, x, about);
    sum += eq13.squaredNorm() + eq14.squaredNorm();
  }
  return sum + 2e6 * (x.real * x.dual.conjugate() + x.dual * x.real.conjugate()).squaredNorm();
}

TEST(NonlinearObjectives, FunctionsAreThePrintedOnes) {
  Random random(1);
  const auto movements = noisy_movements(1.0, 1);
  const Quaternion about = true_rotation();
  const QuaternionObjective quaternion(movements, about);
  const DualQuaternionObjective dual_quaternion(movements, about);
  for (int trial = 0; trial < 100; ++trial) {
    const QuaternionUnknowns x{random.quaternion(), 200 * random.normal3(), random.normal()};
    const double expected = eq7(movements, x, about);
    EXPECT_NEAR(quaternion.value(x), expected, 1e-10 * expected);
    const SimilarityDualQuaternion y{random.quaternion(), 200 * random.quaternion()};
    const double expected_dual = eq15(movements, y, about);
    EXPECT_NEAR(dual_quaternion.value(y), expected_dual, 1e-10 * expected_dual);
  }
}

TEST(NonlinearObjectives, TheTruthSolvesEquations13And14) {
  Random random(2);
  for (int trial = 0; trial < 1000; ++trial) {
    const double scale = random.power_of_ten(-6, 6);
    const HandEyeSolution truth = random_solution(random, 300, scale);
    const Pose eye_from_hand = truth.hand_from_eye.inverse();
    const Quaternion q(eye_from_hand.linear());
    const auto x = SimilarityDualQuaternion::from(q, scale * eye_from_hand.translation(), scale);
    EXPECT_NEAR(x.s() / scale, 1, 1e-14);
    EXPECT_NEAR(x.real.dot(x.dual), 0, 1e-10 * scale * scale);  // eq 12
    EXPECT_TRUE(x.t().isApprox(scale * eye_from_hand.translation(), 1e-13));

    const auto movement = exact_movement(truth, random, random.uniform(0, 2 * kPi), 100);
    const auto [eq13, eq14] = left_minus_right(movement, x, q);
    EXPECT_LT(eq13.norm(), 1e-13 * scale);
    EXPECT_LT(eq14.norm(), 1e-10 * scale);

    Eigen::Matrix<double, 12, 1> monomials;
    const auto w_first = [](const Quaternion& p) {
      return Eigen::Vector4d(p.w(), p.x(), p.y(), p.z());
    };
    monomials << w_first(x.real), w_first(x.dual), w_first(q);
    EXPECT_LT((similarity_rows(movement, q) * monomials).norm(), 1e-10 * scale);
  }
}

/// A start some degrees, centimetres and per cents off.
QuaternionUnknowns rough_start(Random& random) {
  const Pose eye_from_hand = synthetic::scope().solution.hand_from_eye.inverse();
  return {Quaternion(eye_from_hand.linear() * exp_so3(rad_from_deg(4) * random.normal3())),
          eye_from_hand.translation() + 15 * random.normal3(), random.uniform(0.85, 1.15)};
}

void expect_same(const QuaternionUnknowns& a, const QuaternionUnknowns& b, double tolerance) {
  EXPECT_LT(a.q.normalized().angularDistance(b.q.normalized()), tolerance);
  EXPECT_LT((a.t - b.t).norm(), tolerance * b.t.norm());
  EXPECT_NEAR(a.s / b.s, 1, tolerance);
}

TEST(NonlinearObjectives, PenaltyAndManifoldAgreeOnEquation7) {
  Random random(5);
  const QuaternionOptions manifold{.unit_norm = QuaternionOptions::UnitNorm::kManifold};
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    const auto movements = noisy_movements(1.0, seed);
    const QuaternionObjective objective(movements, true_rotation());
    const auto printed = objective.minimise(rough_start(random));
    const auto constrained = objective.minimise(rough_start(random), manifold);
    ASSERT_TRUE(printed && constrained);
    EXPECT_NEAR(constrained->q.norm(), 1, 1e-14);
    expect_same(*printed, *constrained, 1e-7);
    EXPECT_LE(objective.value(*printed), objective.value(*constrained) * (1 + 1e-12));
    EXPECT_NEAR(objective.value(*printed), objective.value(*constrained),
                1e-7 * objective.value(*printed));
  }
}

TEST(NonlinearObjectives, PenaltyAndManifoldAgreeOnEquation15) {
  Random random(6);
  const DualQuaternionOptions manifold{.constraint = DualQuaternionOptions::Constraint::kManifold};
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    const auto movements = noisy_movements(1.0, seed);
    const DualQuaternionObjective objective(movements, true_rotation());
    const auto start = [&] {
      const QuaternionUnknowns rough = rough_start(random);
      return SimilarityDualQuaternion::from(rough.q, rough.t, rough.s);
    };
    const auto printed = objective.minimise(start());
    const auto constrained = objective.minimise(start(), manifold);
    ASSERT_TRUE(printed && constrained);
    EXPECT_NEAR(constrained->real.dot(constrained->dual), 0, 1e-10);
    expect_same({printed->q(), printed->t(), printed->s()},
                {constrained->q(), constrained->t(), constrained->s()}, 1e-7);
    EXPECT_NEAR(objective.value(*printed), objective.value(*constrained),
                1e-7 * objective.value(*printed));
  }
}

TEST(NonlinearObjectives, NoNeighbourIsBetterThanTheMinimum) {
  Random random(7);
  const auto movements = noisy_movements(1.0, 3);
  const QuaternionObjective quaternion(movements, true_rotation());
  const DualQuaternionObjective dual_quaternion(movements, true_rotation());
  const QuaternionUnknowns start = rough_start(random);
  const auto x = quaternion.minimise(start);
  const auto y =
      dual_quaternion.minimise(SimilarityDualQuaternion::from(start.q, start.t, start.s));
  ASSERT_TRUE(x && y);
  for (int trial = 0; trial < 300; ++trial) {
    const double step = random.power_of_ten(-6, -1);
    const QuaternionUnknowns near_x{x->q + 0.01 * step * random.quaternion(),
                                    x->t + step * random.normal3(),
                                    x->s + 0.01 * step * random.normal()};
    EXPECT_GE(quaternion.value(near_x), quaternion.value(*x) * (1 - 1e-12));
    const SimilarityDualQuaternion near_y{y->real + 0.01 * step * random.quaternion(),
                                          y->dual + step * random.quaternion()};
    EXPECT_GE(dual_quaternion.value(near_y), dual_quaternion.value(*y) * (1 - 1e-12));
  }
}

/// With a fixed point, eq 15 falls all the way to s = 0: no answer, rather than that one.
TEST(NonlinearObjectives, Equation15HasNoMinimumOnTheRealLaparoscope) {
  const auto poses = synthetic::real_poses("laparoscope.csv");
  if (poses.empty()) GTEST_SKIP() << "no poses/laparoscope.csv";
  const auto movements = select_movements(poses).movements;
  EXPECT_TRUE(nonlinear_quaternion({.movements = movements}));
  EXPECT_FALSE(nonlinear_dual_quaternion({.movements = movements}));
}

}  // namespace
}  // namespace handeye
