// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/wet_film.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "tests/unit/simulator/disturbed_world.hpp"

namespace handeye::simulator {
namespace {

class WetFilmTest : public testing::Test {
 protected:
  static World wet_world(std::uint64_t seed) {
    SimulatorOptions options = quiet_options(seed);
    options.disturbances.highlights = true;
    return {options, 0};
  }
};

TEST_F(WetFilmTest, ThrowsTensOfSmallSaturatedSpots) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const World world = wet_world(seed);
    EndoscopeView view(world);
    for (const std::uint32_t number : {0U, 60U, 130U}) {
      const cv::Mat1b grey = drawn(view, number);
      const cv::Mat saturated = grey == 255;
      cv::Mat labels;
      cv::Mat stats;
      cv::Mat centroids;
      const int spots = cv::connectedComponentsWithStats(saturated, labels, stats, centroids) - 1;
      EXPECT_GE(spots, 20);
      EXPECT_LE(spots, 250);
      EXPECT_LT(cv::countNonZero(saturated), static_cast<int>(grey.total() / 25));
      std::vector<int> lengths;
      for (int spot = 1; spot <= spots; ++spot) {
        lengths.push_back(std::max(stats.at<int>(spot, cv::CC_STAT_WIDTH),
                                   stats.at<int>(spot, cv::CC_STAT_HEIGHT)));
      }
      std::ranges::sort(lengths);
      EXPECT_GE(lengths[lengths.size() / 2], 2);
      EXPECT_LE(lengths[lengths.size() * 9 / 10], 20);
    }
  }
}

TEST_F(WetFilmTest, SpotsDoNotStayOnTheSurface) {
  const World world = wet_world(4);
  EndoscopeView view(world);
  const auto eye_pose = [&](std::uint32_t number) {
    return world.motion.surface_from_eye(view.exposed_s(number));
  };
  const cv::Mat1b first = drawn(view, 20);
  const cv::Mat1f depth_mm = view.depth_mm().clone();
  const cv::Mat1b later = drawn(view, 35);
  const Pose later_from_first = eye_pose(35).inverse() * eye_pose(20);
  int bright = 0;
  int still_bright = 0;
  for (int row = 0; row < first.rows; ++row) {
    for (int column = 0; column < first.cols; ++column) {
      if (first(row, column) < 255) continue;
      const Eigen::Vector2d ray = unproject(world.camera, Eigen::Vector2d(column, row)).value();
      const Eigen::Vector2d seen = project<double>(
          world.camera,
          later_from_first * (static_cast<double>(depth_mm(row, column)) * ray.homogeneous()));
      const cv::Point pixel(static_cast<int>(std::lround(seen.x())),
                            static_cast<int>(std::lround(seen.y())));
      if (!cv::Rect({}, later.size()).contains(pixel)) continue;
      ++bright;
      still_bright += static_cast<int>(later(pixel) == 255);
    }
  }
  ASSERT_GT(bright, 300);
  EXPECT_LT(still_bright, bright / 3);
}

TEST_F(WetFilmTest, DrySurfacesHaveNone) {
  const World world(quiet_options(1), 0);
  EndoscopeView view(world);
  EXPECT_EQ(cv::countNonZero(drawn(view, 0) == 255), 0);
}

}  // namespace
}  // namespace handeye::simulator
