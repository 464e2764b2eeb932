// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/lattice_noise.hpp"

#include <gtest/gtest.h>

namespace handeye::simulator {
namespace {

double variance(const cv::Mat1f& field) {
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(field, mean, deviation);
  return deviation[0] * deviation[0];
}

TEST(LatticeNoise, SubdivisionKeepsAConstantAndTheMean) {
  const cv::Mat1f constant(8, 8, 3.25F);
  EXPECT_EQ(cv::norm(subdivide(constant), cv::Mat1f(16, 16, 3.25F), cv::NORM_INF), 0.0);

  RandomStream random(5, Purpose::kTexture);
  cv::Mat1f field = spline_noise(16, 64, random);
  field += 1.5F;
  EXPECT_NEAR(cv::mean(subdivide(field))[0], cv::mean(field)[0], 1e-6);
}

TEST(LatticeNoise, SubdivisionIsTheCubicSpline) {
  // One coefficient of 1: a cubic B-spline is 2/3 at its knot, 1/6 at the knots beside it.
  cv::Mat1f field(8, 8, 0.0F);
  field(3, 3) = 1.0F;
  for (int step = 0; step < 7; ++step) field = subdivide(field);
  const int knot = field.rows / 8;
  // Subdivision's coefficients converge to the spline's values with the square of their spacing.
  EXPECT_NEAR(field(3 * knot, 3 * knot), 4.0 / 9.0, 1e-4);
  EXPECT_NEAR(field(3 * knot, 4 * knot), 1.0 / 9.0, 1e-4);
  EXPECT_NEAR(field(4 * knot, 2 * knot), 1.0 / 36.0, 1e-4);
  EXPECT_EQ(field(3 * knot, 6 * knot), 0.0F);
}

TEST(LatticeNoise, IsNormalisedPeriodicAndDrawnFromTheSeed) {
  RandomStream random(11, Purpose::kTexture);
  const cv::Mat1f field = fractal_noise({8, 64, 0.5}, 256, random);
  EXPECT_NEAR(cv::mean(field)[0], 0.0, 1e-4);
  EXPECT_NEAR(variance(field), 1.0, 1e-4);

  // The step over the tile's edge is no larger than the steps inside.
  double inside = 0;
  double over_edge = 0;
  for (int row = 0; row < 256; ++row) {
    for (int i = 0; i < 255; ++i) {
      inside = std::max<double>(inside, std::abs(field(row, i + 1) - field(row, i)));
    }
    over_edge = std::max<double>(over_edge, std::abs(field(row, 0) - field(row, 255)));
  }
  EXPECT_LE(over_edge, 1.2 * inside);

  RandomStream again(11, Purpose::kTexture);
  EXPECT_EQ(cv::norm(field, fractal_noise({8, 64, 0.5}, 256, again), cv::NORM_INF), 0.0);
  RandomStream other(12, Purpose::kTexture);
  EXPECT_GT(cv::norm(field, fractal_noise({8, 64, 0.5}, 256, other), cv::NORM_INF), 1.0);
}

}  // namespace
}  // namespace handeye::simulator
