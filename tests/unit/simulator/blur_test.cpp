// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/blur.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace handeye::simulator {
namespace {

const CameraModel kCamera{160, 120, 150, 150, 79.5, 59.5, {-0.1, 0, 0, 0, 0}};
constexpr float kDepthMm = 50;

/// Where a spot of light is and how far it spreads.
struct Spread {
  double total{0}, x{0}, y{0}, variance_x{0}, variance_y{0};
};

Spread spread_of(const cv::Mat1f& radiance) {
  Spread spread;
  const auto sum = [&radiance](auto&& value) {
    double total = 0;
    for (int row = 0; row < radiance.rows; ++row) {
      for (int column = 0; column < radiance.cols; ++column) {
        total += static_cast<double>(radiance(row, column)) * value(column, row);
      }
    }
    return total;
  };
  spread.total = sum([](int, int) { return 1.0; });
  spread.x = sum([](int x, int) { return static_cast<double>(x); }) / spread.total;
  spread.y = sum([](int, int y) { return static_cast<double>(y); }) / spread.total;
  spread.variance_x = sum([&](int x, int) { return std::pow(x - spread.x, 2); }) / spread.total;
  spread.variance_y = sum([&](int, int y) { return std::pow(y - spread.y, 2); }) / spread.total;
  return spread;
}

/// A single bright pixel a little off the middle, where the lens hardly distorts.
cv::Mat1f point() {
  cv::Mat1f radiance(kCamera.height, kCamera.width, 0.0F);
  radiance(64, 84) = 1;
  return radiance;
}

TEST(Blur, DefocusSpreadsAPointByItsSigma) {
  cv::Mat1f radiance = point();
  defocus(1.5, radiance);
  const Spread spread = spread_of(radiance);
  EXPECT_NEAR(spread.total, 1, 1e-4);
  EXPECT_NEAR(spread.x, 84, 1e-4);
  EXPECT_NEAR(std::sqrt(spread.variance_x), 1.5, 0.05);
  EXPECT_NEAR(std::sqrt(spread.variance_y), 1.5, 0.05);

  cv::Mat1f sharp = point();
  defocus(0, sharp);
  EXPECT_EQ(cv::norm(sharp, point(), cv::NORM_INF), 0.0);
}

TEST(Blur, MotionDrawsAPointOutAlongItsWay) {
  const cv::Mat1f depth_mm(kCamera.height, kCamera.width, kDepthMm);
  Pose begin_from_middle = Pose::Identity();
  Pose end_from_middle = Pose::Identity();
  begin_from_middle.translation().x() = -1;
  end_from_middle.translation().x() = 1;
  MotionBlur blur(kCamera);
  cv::Mat1f radiance = point();
  blur.apply(depth_mm, begin_from_middle, end_from_middle, radiance);
  const Spread spread = spread_of(radiance);
  const double way_px = 2 * kCamera.fx / static_cast<double>(kDepthMm);
  EXPECT_NEAR(spread.x, 84, 0.05);
  EXPECT_NEAR(spread.y, 64, 0.05);
  // A uniform line; bilinear interpolation adds a sixth of a square pixel at most.
  EXPECT_NEAR(spread.variance_x, way_px * way_px / 12, 0.25);
  EXPECT_LT(spread.variance_y, 0.1);
}

TEST(Blur, AStillScopeDoesNotBlur) {
  const cv::Mat1f depth_mm(kCamera.height, kCamera.width, kDepthMm);
  MotionBlur blur(kCamera);
  cv::Mat1f radiance = point();
  blur.apply(depth_mm, Pose::Identity(), Pose::Identity(), radiance);
  EXPECT_LT(cv::norm(radiance, point(), cv::NORM_INF), 1e-6);
}

}  // namespace
}  // namespace handeye::simulator
