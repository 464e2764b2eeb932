// SPDX-License-Identifier: BSD-3-Clause
// What stands between the scene and the sensor: the field stop and the instrument.
#include <algorithm>

#include <gtest/gtest.h>

#include "drivers/simulator/field_stop.hpp"
#include "drivers/simulator/instrument.hpp"
#include "tests/unit/simulator/disturbed_world.hpp"

namespace handeye::simulator {
namespace {

TEST(FieldStop, LeavesADiscAndDarkensTheRest) {
  SimulatorOptions options = quiet_options(4);
  const World open_world(options, 0);
  options.disturbances.round_view = true;
  const World world(options, 0);
  EndoscopeView open_view(open_world);
  EndoscopeView view(world);
  const cv::Mat1b open_grey = drawn(open_view, 3);
  const cv::Mat1b grey = drawn(view, 3);
  const FieldStop stop(options.width, options.height, options.seed);
  EXPECT_LT((stop.centre_px() - Eigen::Vector2d(319.5, 239.5)).norm(), 15.0);
  EXPECT_NEAR(stop.radius_px(), 228.0, 1.0);
  int glowing = 0;
  for (int row = 0; row < grey.rows; ++row) {
    for (int column = 0; column < grey.cols; ++column) {
      const double outside_px =
          (Eigen::Vector2d(column, row) - stop.centre_px()).norm() - stop.radius_px();
      if (outside_px < -2) {
        ASSERT_EQ(grey(row, column), open_grey(row, column));
      }
      if (outside_px > 2) {
        ASSERT_LE(grey(row, column), 8);
      }
      if (outside_px > 2 && outside_px < 8) glowing += static_cast<int>(grey(row, column) > 1);
      if (outside_px > 60) {
        ASSERT_EQ(grey(row, column), 0);
      }
    }
  }
  EXPECT_GT(glowing, 1000);
}

TEST(Instrument, HidesUpToAThirdAndMovesOnItsOwn) {
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    const Instrument instrument(640, 480, seed);
    const cv::Mat1f scene(480, 640, 0.4F);
    const cv::Mat1f depth(480, 640, 80.0F);
    double largest_share = 0;
    double mean_share = 0;
    cv::Mat hidden_before;
    for (int second = 0; second < 20; ++second) {
      cv::Mat1f radiance = scene.clone();
      cv::Mat1f depth_mm = depth.clone();
      instrument.draw(second, radiance, depth_mm);
      const cv::Mat hidden = depth_mm == 0;
      const double share = cv::countNonZero(hidden) / static_cast<double>(hidden.total());
      largest_share = std::max(largest_share, share);
      mean_share += share / 20;
      // It comes in from a side, and does not change what it leaves open.
      EXPECT_GT(cv::countNonZero(hidden.col(0)) + cv::countNonZero(hidden.col(639)), 50);
      EXPECT_EQ(cv::norm(radiance, scene, cv::NORM_INF, depth_mm > 0), 0.0);
      // Shine beyond what the sensor can tell.
      EXPECT_GT(cv::countNonZero(radiance > 2), 50);
      if (!hidden_before.empty()) {
        EXPECT_GT(cv::countNonZero(hidden != hidden_before), 500) << "at " << second << " s";
      }
      hidden_before = hidden;
    }
    EXPECT_LT(largest_share, 0.36);
    EXPECT_GT(largest_share, 0.22);
    EXPECT_GT(mean_share, 0.15);
  }
}

TEST(Instrument, IsTexturedAndTakesTheDepthAway) {
  SimulatorOptions options = quiet_options(4);
  options.disturbances.instrument = true;
  const World world(options, 0);
  EndoscopeView view(world);
  const cv::Mat1b grey = drawn(view, 3);
  const cv::Mat hidden = view.depth_mm() == 0;
  cv::Mat change;
  cv::absdiff(grey.colRange(1, grey.cols), grey.colRange(0, grey.cols - 1), change);
  EXPECT_GT(cv::mean(change, hidden.colRange(1, grey.cols))[0], 3.0);
  EXPECT_LT(cv::mean(change, ~hidden.colRange(1, grey.cols))[0], 1.0);
}

}  // namespace
}  // namespace handeye::simulator
