// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/pattern/intrinsics.hpp"

#include <random>

#include <gtest/gtest.h>

#include "tests/unit/pattern/board_images.hpp"

namespace handeye {
namespace {

using Views = std::vector<std::vector<BoardCorner>>;

const Board kBoard = test::chessboard(9, 6, 6);

std::vector<Pose> varied_poses(int count, double largest_tilt, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> side(-1, 1);
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) {
    const double distance_mm = 80 + 15 * side(random);
    const Eigen::Vector3d tilt(largest_tilt * side(random), largest_tilt * side(random),
                               2 * side(random));
    const Eigen::Vector2d shift_mm(8 * side(random), 5 * side(random));
    poses.push_back(test::board_in_view(kBoard, distance_mm, tilt, shift_mm));
  }
  return poses;
}

Views views_of(const std::vector<Pose>& poses, const CameraModel& camera, double noise_px,
               std::uint32_t seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, noise_px);
  Views views;
  for (const Pose& pose : poses) {
    std::vector<BoardCorner>& view = views.emplace_back();
    for (const Eigen::Vector3d& corner_mm : kBoard.corners_mm()) {
      const Eigen::Vector2d pixel = project<double>(camera, Eigen::Vector3d(pose * corner_mm)) +
                                    Eigen::Vector2d(noise(random), noise(random));
      view.push_back({static_cast<int>(view.size()), pixel});
    }
  }
  return views;
}

TEST(Intrinsics, AreRecoveredFromPictures) {
  const CameraModel truth = test::endoscope();
  test::BoardImages images(kBoard, truth);
  const auto detector = make_board_detector(kBoard, {.thorough = true});
  Views views;
  for (const Pose& pose : varied_poses(12, 0.5, 3)) {
    std::vector<BoardCorner> corners;
    detector->detect(images.image(pose), corners);
    if (!corners.empty()) views.push_back(corners);
  }
  ASSERT_GE(views.size(), 8U);
  const Intrinsics found = calibrate_intrinsics(kBoard, views, {truth.width, truth.height});
  EXPECT_EQ(found.problem, IntrinsicsProblem::kNone);
  EXPECT_NEAR(found.camera.fx, truth.fx, 0.003 * truth.fx);
  EXPECT_NEAR(found.camera.fy, truth.fy, 0.003 * truth.fy);
  EXPECT_NEAR(found.camera.cx, truth.cx, 2);
  EXPECT_NEAR(found.camera.cy, truth.cy, 2);
  EXPECT_NEAR(found.camera.distortion[0], truth.distortion[0], 0.02);
  EXPECT_LT(found.reprojection_px, 0.15);
  ASSERT_EQ(found.view_reprojection_px.size(), views.size());
}

/// Errors divided by the claimed sigma have a mean square of one.
TEST(Intrinsics, StandardDeviationsAreHonest) {
  const CameraModel truth = test::endoscope();
  const std::vector<Pose> poses = varied_poses(8, 0.5, 5);
  double squares = 0;
  constexpr int kTrials = 40;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Views views = views_of(poses, truth, 0.2, static_cast<std::uint32_t>(100 + trial));
    const Intrinsics found = calibrate_intrinsics(kBoard, views, {truth.width, truth.height});
    ASSERT_EQ(found.problem, IntrinsicsProblem::kNone);
    squares += std::pow((found.camera.fx - truth.fx) / found.sigma.fx, 2) / 4;
    squares += std::pow((found.camera.fy - truth.fy) / found.sigma.fy, 2) / 4;
    squares += std::pow((found.camera.cx - truth.cx) / found.sigma.cx, 2) / 4;
    squares += std::pow((found.camera.cy - truth.cy) / found.sigma.cy, 2) / 4;
  }
  // fx and fy go together, so these are some 3 * 40 independent figures.
  EXPECT_NEAR(squares / kTrials, 1.0, 0.5);
}

TEST(Intrinsics, ThirdRadialCoefficientOnlyWhereTheViewsShowOne) {
  CameraModel camera = test::endoscope();
  const std::vector<Pose> poses = varied_poses(12, 0.5, 7);
  EXPECT_EQ(
      calibrate_intrinsics(kBoard, views_of(poses, camera, 0.2), {640, 480}).camera.distortion[4],
      0);
  camera.distortion = {-0.35, 0.2, 0, 0, -0.8};
  const Intrinsics found = calibrate_intrinsics(kBoard, views_of(poses, camera, 0.02), {640, 480});
  EXPECT_NEAR(found.camera.distortion[4], -0.8, 5 * found.sigma.distortion[4]);
  EXPECT_NE(found.camera.distortion[4], 0);
}

TEST(Intrinsics, AreRefusedForParallelViews) {
  std::vector<Pose> poses;
  for (int i = 0; i < 6; ++i) {
    poses.push_back(test::board_in_view(kBoard, 80 + 3 * i, {0, 0, 0.3 * i}, {2.0 * i - 5, 0}));
  }
  const CameraModel camera{640, 480, 520, 520, 320, 240, {}};
  for (const double noise_px : {0.0, 0.2}) {
    const Intrinsics found =
        calibrate_intrinsics(kBoard, views_of(poses, camera, noise_px), {640, 480});
    EXPECT_EQ(found.problem, IntrinsicsProblem::kParallelViews) << noise_px;
  }
}

TEST(Intrinsics, AreRefusedWhenUncertain) {
  std::vector<Pose> poses;
  for (int i = 0; i < 3; ++i) {
    poses.push_back(test::board_in_view(kBoard, 300, {0.1 * i, 0.12 - 0.1 * i, 0}));
  }
  const Intrinsics found =
      calibrate_intrinsics(kBoard, views_of(poses, test::endoscope(), 0.5), {640, 480});
  EXPECT_EQ(found.problem, IntrinsicsProblem::kUncertain);
  EXPECT_NE(intrinsics_advice(found.problem), "");
}

TEST(Intrinsics, AreRefusedForAnotherBoard) {
  const std::vector<Pose> poses = varied_poses(8, 0.5, 9);
  Views views = views_of(poses, test::endoscope(), 0.1);
  for (auto& view : views) {
    for (BoardCorner& corner : view) corner.id = (corner.id * 7) % 54;
  }
  EXPECT_NE(calibrate_intrinsics(kBoard, views, {640, 480}).problem, IntrinsicsProblem::kNone);
}

}  // namespace
}  // namespace handeye
