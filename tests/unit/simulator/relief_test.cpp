// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/relief.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "daemon/geometry/pose.hpp"
#include "drivers/simulator/random_stream.hpp"

namespace handeye::simulator {
namespace {

/// The plain way: small steps, then halving.
double first_hit_brute_force(const Relief& relief, const Eigen::Vector3d& origin,
                             const Eigen::Vector3d& direction) {
  const auto gap = [&](double along) {
    const Eigen::Vector3d point = origin + along * direction;
    return point.z() - relief.height(point.x(), point.y());
  };
  constexpr double kStepMm = 0.05;
  double above = 0;
  while (gap(above + kStepMm) > 0) above += kStepMm;
  double below = above + kStepMm;
  for (int halving = 0; halving < 50; ++halving) {
    const double middle = 0.5 * (above + below);
    (gap(middle) > 0 ? above : below) = middle;
  }
  return above;
}

TEST(Relief, HasTheHeightsItPromises) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    const Relief relief(seed);
    // 10 to 20 % of the viewing distance of 80 mm: enough for parallax.
    EXPECT_GE(relief.highest_mm() - relief.lowest_mm(), 8.0);
    EXPECT_LE(relief.highest_mm() - relief.lowest_mm(), 16.0);
    RandomStream random(seed, Purpose::kMotion);
    double steepest = 0;
    for (int i = 0; i < 20'000; ++i) {
      const double x = random.uniform(-300, 300);
      const double y = random.uniform(-300, 300);
      const double around = random.uniform(0, 2 * kPi);
      const double here = relief.height(x, y);
      const double there = relief.height(x + 0.01 * std::cos(around), y + 0.01 * std::sin(around));
      steepest = std::max(steepest, std::abs(there - here) / 0.01);
      EXPECT_GE(here, relief.lowest_mm() - 1e-4);
      EXPECT_LE(here, relief.highest_mm() + 1e-4);
    }
    EXPECT_LE(steepest, ReliefOptions{}.max_slope * 1.01);
  }
}

TEST(Relief, SinglePrecisionSampleAgreesAndIsPeriodic) {
  const Relief relief(3);
  const double tile_mm = ReliefOptions{}.tile_mm;
  RandomStream random(3, Purpose::kMotion);
  for (int i = 0; i < 5'000; ++i) {
    const double x = random.uniform(-250, 250);
    const double y = random.uniform(-250, 250);
    const double height = relief.height(x, y);
    const auto node = relief.sample(static_cast<float>(x), static_cast<float>(y));
    EXPECT_NEAR(static_cast<double>(node[0]), height, 2e-4);
    EXPECT_NEAR(relief.height(x + tile_mm, y - tile_mm), height, 1e-4);
    // The slopes are smoothed over two cells of 0.4 mm.
    const double slope_x = (relief.height(x + 0.4, y) - relief.height(x - 0.4, y)) / 0.8;
    const double slope_y = (relief.height(x, y + 0.4) - relief.height(x, y - 0.4)) / 0.8;
    EXPECT_NEAR(static_cast<double>(node[1]), slope_x, 2e-3);
    EXPECT_NEAR(static_cast<double>(node[2]), slope_y, 2e-3);
  }
}

TEST(Relief, RaysMeetItWhereBruteForceSays) {
  const Relief relief(8);
  RandomStream random(8, Purpose::kMotion);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d origin(random.uniform(-100, 100), random.uniform(-100, 100),
                                 random.uniform(30, 110));
    const double tilt = rad_from_deg(random.uniform(0, 80));
    const double around = random.uniform(0, 2 * kPi);
    const Eigen::Vector3d direction(std::sin(tilt) * std::cos(around),
                                    std::sin(tilt) * std::sin(around), -std::cos(tilt));
    const auto hit = relief.intersect(origin, direction, 2000.0);
    ASSERT_TRUE(hit.has_value());
    EXPECT_NEAR(*hit, first_hit_brute_force(relief, origin, direction), 1e-6);
  }
}

TEST(Relief, RaysThatDoNotComeDownMeetNothing) {
  const Relief relief(8);
  EXPECT_FALSE(relief.intersect({0, 0, 80}, {0, 0, 1}, 1e4).has_value());
  EXPECT_FALSE(relief.intersect({0, 0, -80}, {0, 0, -1}, 1e4).has_value());
  EXPECT_FALSE(relief.intersect({0, 0, 80}, {0, 0, -1}, 10.0).has_value());
}

}  // namespace
}  // namespace handeye::simulator
