// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/perspective/lens.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace handeye {
namespace {

TEST(SensorLens, UndistortsInMillimetresOnTheSensor) {
  const SensorLens lens{.pixel_mm = {0.01, 0.02}, .centre_px = {100, 50}, .k1_per_mm2 = 0.001};
  const Eigen::Vector2d x_d(2.0, -1.0);  // 200 px to the right, 50 px up
  const Eigen::Vector2d expected = x_d * (1.0 + 0.001 * 5.0);
  EXPECT_LT((undistorted_mm(lens, {300, 0}) - expected).norm(), 1e-14);
}

TEST(SensorLens, DistortingUndoesUndistorting) {
  for (const double k1 : {-0.01, -0.000432, 0.0, 0.000432, 0.05}) {
    const SensorLens lens{.pixel_mm = {0.0087, 0.0083}, .centre_px = {256, 250}, .k1_per_mm2 = k1};
    for (const double u : {0.0, 100.0, 256.0, 511.0}) {
      for (const double v : {0.0, 250.0, 511.0}) {
        const Eigen::Vector2d pixel(u, v);
        EXPECT_LT((distorted_pixel(lens, undistorted_mm(lens, pixel)) - pixel).norm(), 1e-10)
            << k1 << " at " << pixel.transpose();
      }
    }
  }
}

TEST(DistortedRadius, StopsWhereTheBarrelFolds) {
  const double k1 = -0.01;
  const double last = 1.0 / std::sqrt(-3.0 * k1);
  EXPECT_DOUBLE_EQ(distorted_radius(k1, 100.0), last);
  const double just_inside = 0.999 * last * (1.0 + k1 * last * last);
  const double radius = distorted_radius(k1, just_inside);
  EXPECT_LT(radius, last);
  EXPECT_NEAR(radius * (1.0 + k1 * radius * radius), just_inside, 1e-14);
}

TEST(DistortedRadius, HoldsForLensesOfEveryStrength) {
  for (const double k1 : {1e-9, 1e-3, 1.0, 1e6}) {
    for (const double target : {1e-9, 1e-3, 1.0, 1e3}) {
      const double radius = distorted_radius(k1, target);
      EXPECT_NEAR(radius * (1.0 + k1 * radius * radius) / target, 1.0, 1e-13) << k1 << target;
    }
  }
}

}  // namespace
}  // namespace handeye
