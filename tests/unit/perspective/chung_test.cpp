// SPDX-License-Identifier: BSD-3-Clause
// The computer simulation of Chung's paper: what its tables and figures show must come out.
#include <gtest/gtest.h>

#include "daemon/handeye/perspective/gauss_newton.hpp"
#include "tests/unit/perspective/chung_simulation.hpp"

namespace handeye {
namespace {

using namespace test;

constexpr int kMostSteps = 6;

/// Y within 1e-6 of the ideal in every component, after at most six steps.
void expect_ideal_from(const PerspectiveState& start) {
  const auto found = gauss_newton(chung::observe({}), start);
  ASSERT_TRUE(found);
  EXPECT_LE(found->iterations, kMostSteps);
  const auto ideal = chung::y_vector(chung::object_from_hand());
  const auto y = chung::y_vector(found->state.object_from_hand);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(y(i) / ideal(i), 1.0, 1e-6) << "component " << i;
  EXPECT_NEAR(found->state.lens.k1_per_mm2 / chung::kK1_per_mm2, 1.0, 1e-6);
  EXPECT_LT((found->state.lens.centre_px - chung::lens().centre_px).norm(), 1e-4);
}

TEST(Chung, TheIdealYIsThePrintedOne) {
  const auto difference = chung::y_vector(chung::object_from_hand()) - chung::printed_ideal();
  chung::YVector half_a_digit;
  half_a_digit << 5e-5, 5e-5, 5e-6, 5e-4, 5e-6, 5e-3;
  for (int i = 0; i < 6; ++i) EXPECT_LE(std::abs(difference(i)), half_a_digit(i)) << i;
}

TEST(Chung, TheObjectFillsTheImage) {
  constexpr double kMargin = 0.07 * chung::kWidth;
  for (const ObservedPosition& position : chung::observe({}).positions) {
    Eigen::Vector2d low(chung::kWidth, chung::kHeight);
    Eigen::Vector2d high(0, 0);
    for (const ObjectPoint& point : position.points) {
      low = low.cwiseMin(point.pixel);
      high = high.cwiseMax(point.pixel);
    }
    EXPECT_GE(low.minCoeff(), 0.0);
    EXPECT_LE(low.maxCoeff(), kMargin);
    EXPECT_GE(high.minCoeff(), chung::kWidth - 1 - kMargin);
    EXPECT_LE(high.maxCoeff(), chung::kWidth - 1);
  }
}

TEST(Chung, ExactMatricesObeyTheMatrixEquation) {
  const Pose y = chung::object_from_hand();
  const auto matrices = chung::matrices();
  const auto hands = chung::hand1_from_hands();
  for (std::size_t i = 0; i < hands.size(); ++i) {
    const PerspectiveMatrix left = matrices[i] * y.matrix() * hands[i].matrix();
    const PerspectiveMatrix right = matrices[0] * y.matrix();
    EXPECT_LT((left - right).norm() / right.norm(), 1e-14) << i;
  }
}

TEST(Chung, WithoutDistortionTheMatrixMethodIsExact) {
  const Observations observations = chung::observe({}, 0.0);
  SensorLens lens = chung::lens();
  lens.k1_per_mm2 = 0.0;
  const auto matrices = matrices_by_dlt(observations, lens);
  ASSERT_TRUE(matrices);
  const auto positions = matrix_positions(observations, *matrices);
  const auto ideal = chung::y_vector(chung::object_from_hand());
  const auto start = closed_form_object_from_hand(positions);
  ASSERT_TRUE(start);
  EXPECT_LT((chung::y_vector(*start) - ideal).cwiseQuotient(ideal).cwiseAbs().maxCoeff(), 1e-6);
  const auto found = matrix_method(positions, chung::pose_of(0.75 * ideal));
  ASSERT_TRUE(found);
  EXPECT_LE(found->iterations, kMostSteps);
  const auto y = chung::y_vector(found->object_from_hand);
  EXPECT_LT((y - ideal).cwiseQuotient(ideal).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(Chung, IgnoringTheDistortionCostsAPerCentAndMillimetres) {
  const Observations observations = chung::observe({});
  SensorLens lens = chung::lens();
  lens.k1_per_mm2 = 0.0;
  const auto matrices = matrices_by_dlt(observations, lens);
  ASSERT_TRUE(matrices);
  const auto found =
      matrix_method(matrix_positions(observations, *matrices), chung::object_from_hand());
  ASSERT_TRUE(found);
  const auto ideal = chung::y_vector(chung::object_from_hand());
  const chung::YVector error = chung::y_vector(found->object_from_hand) - ideal;
  const double z_percent =
      100.0 * error.head<3>().cwiseQuotient(ideal.head<3>()).cwiseAbs().maxCoeff();
  EXPECT_GT(z_percent, 0.3);  // the paper's: 0.57, 0.54, 1.24 %
  EXPECT_LT(z_percent, 3.0);
  EXPECT_GT(error.tail<3>().norm(), 1.0);  // the paper's: 2.6 mm
  EXPECT_LT(error.tail<3>().norm(), 10.0);
}

TEST(Chung, ConvergesFrom75PercentOfRotationAndTranslation) {
  PerspectiveState start = chung::truth();
  start.object_from_hand = chung::pose_of(0.75 * chung::y_vector(chung::object_from_hand()));
  expect_ideal_from(start);
}

TEST(Chung, ConvergesFrom75PercentOfDistortionAndCentre) {
  PerspectiveState start = chung::truth();
  start.lens.k1_per_mm2 *= 0.75;
  expect_ideal_from(start);
  start.lens.centre_px *= 0.75;
  expect_ideal_from(start);
  start.lens.k1_per_mm2 = chung::kK1_per_mm2;
  expect_ideal_from(start);
}

TEST(Chung, ConvergesFrom90PercentOfTheMatrix) {
  PerspectiveState start = chung::truth();
  for (PerspectiveMatrix& matrix : start.matrices) matrix *= 0.9;
  expect_ideal_from(start);
  // With the last element as the scale, 90 % of the others is another matrix.
  start = chung::truth();
  for (PerspectiveMatrix& matrix : start.matrices) {
    const double last = matrix(2, 3);
    matrix *= 0.9;
    matrix(2, 3) = last;
  }
  expect_ideal_from(start);
}

TEST(Chung, ConvergesFrom90PercentOfEveryElementOfTheMatrix) {
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) {
      SCOPED_TRACE(::testing::Message() << "element " << row << ", " << column);
      PerspectiveState start = chung::truth();
      for (PerspectiveMatrix& matrix : start.matrices) matrix(row, column) *= 0.9;
      expect_ideal_from(start);
    }
  }
}

TEST(Chung, ConvergesFromAllThreeErrorsTogether) {
  PerspectiveState start = chung::truth();
  start.object_from_hand = chung::pose_of(0.75 * chung::y_vector(chung::object_from_hand()));
  start.lens.k1_per_mm2 *= 0.75;
  start.lens.centre_px *= 0.75;
  for (PerspectiveMatrix& matrix : start.matrices) matrix *= 0.9;
  expect_ideal_from(start);
}

}  // namespace
}  // namespace handeye
