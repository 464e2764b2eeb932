// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/pattern/board_pose.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/unit/pattern/board_images.hpp"

namespace handeye {
namespace {

const CameraModel kCamera = test::endoscope();

std::vector<BoardCorner> corners_at(const Board& board, const Pose& eye_from_board, double noise_px,
                                    std::uint32_t seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, noise_px > 0 ? noise_px : 1);
  std::vector<BoardCorner> corners;
  int id = 0;
  for (const Eigen::Vector3d& corner_mm : board.corners_mm()) {
    const Eigen::Vector3d point_eye = eye_from_board * corner_mm;
    Eigen::Vector2d pixel = project<double>(kCamera, point_eye);
    if (noise_px > 0) pixel += Eigen::Vector2d(noise(random), noise(random));
    corners.push_back({id++, pixel});
  }
  return corners;
}

double angle_deg(const Pose& a, const Pose& b) {
  return deg_from_rad(rotation_angle_rad(a.linear(), b.linear()));
}

TEST(BoardPose, IsExactWithoutNoise) {
  const Board board = test::chessboard(9, 6, 6);
  for (const Eigen::Vector3d& tilt : {Eigen::Vector3d(0.4, 0.2, 0.1),
                                      Eigen::Vector3d(-0.3, 0.5, 2.8), Eigen::Vector3d(0, 0, 1)}) {
    const Pose truth = test::board_in_view(board, 80, tilt, {5, -3});
    const auto found = board_pose(board.corners_mm(), corners_at(board, truth, 0), kCamera);
    ASSERT_TRUE(found);
    // The corners are handed to OpenCV in single precision.
    EXPECT_LT(angle_deg(found->eye_from_board, truth), 1e-3);
    EXPECT_LT((found->eye_from_board.translation() - truth.translation()).norm(), 1e-3);
    EXPECT_LT(found->reprojection_px, 1e-3);
  }
}

TEST(BoardPose, TellsTheCornersNoise) {
  const Board board = test::chessboard(9, 6, 6);
  const Pose truth = test::board_in_view(board, 80, {0.4, 0.2, 0.1});
  const auto found = board_pose(board.corners_mm(), corners_at(board, truth, 0.2), kCamera);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->reprojection_px, 0.2 * std::sqrt(2.0), 0.05);
  EXPECT_LT(angle_deg(found->eye_from_board, truth), 0.3);
  EXPECT_LT((found->eye_from_board.translation() - truth.translation()).norm(), 0.3);
}

TEST(BoardPose, OfAPartOfTheBoardIsThatOfTheWhole) {
  const Board board = test::charuco(8, 5, 7, 5);
  const Pose truth = test::board_in_view(board, 80, {0.3, -0.4, 0.7});
  std::vector<BoardCorner> corners = corners_at(board, truth, 0);
  corners.erase(corners.begin(), corners.begin() + 16);
  const auto found = board_pose(board.corners_mm(), corners, kCamera);
  ASSERT_TRUE(found);
  EXPECT_LT((found->eye_from_board.translation() - truth.translation()).norm(), 1e-2);
}

/// From afar, with noise, the mirror pose fits as well: whatever is answered must be the true one.
TEST(BoardPose, IsNeverItsMirrorImage) {
  const Board board = test::chessboard(5, 4, 2);
  int answered = 0;
  int left_out = 0;
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    const double distance_mm = 40 + seed % 10 * 25;
    const Pose truth = test::board_in_view(board, distance_mm, {0.5, 0.2, 0.3});
    const auto found = board_pose(board.corners_mm(), corners_at(board, truth, 0.1, seed), kCamera);
    if (!found) {
      ++left_out;
      continue;
    }
    ++answered;
    EXPECT_LT(angle_deg(found->eye_from_board, truth), 25) << seed << " at " << distance_mm;
  }
  EXPECT_GT(answered, 60);
  EXPECT_GT(left_out, 10);
}

TEST(BoardPose, IsNothingForWhatDeterminesNone) {
  const Board board = test::chessboard(9, 6, 6);
  const Pose truth = test::board_in_view(board, 80, {0.4, 0.2, 0.1});
  const std::vector<BoardCorner> corners = corners_at(board, truth, 0);
  const auto with = [&](const std::vector<BoardCorner>& some) {
    return board_pose(board.corners_mm(), some, kCamera).has_value();
  };
  EXPECT_FALSE(with({}));
  EXPECT_FALSE(with({corners[0], corners[1], corners[9]}));
  EXPECT_FALSE(with({corners.begin(), corners.begin() + 9})) << "one row";
  std::vector<BoardCorner> diagonal;
  for (std::size_t i = 0; i < 6; ++i) diagonal.push_back(corners[10 * i]);
  EXPECT_FALSE(with(diagonal));
  std::vector<BoardCorner> shuffled = corners;
  for (BoardCorner& corner : shuffled) corner.id = (corner.id * 7) % 54;
  EXPECT_FALSE(with(shuffled)) << "not this board";
}

TEST(BoardPose, IsNoneForCornersThatAreNonsense) {
  const Board board = test::chessboard(9, 6, 6);
  const auto corners_mm = board.corners_mm();
  const auto good = corners_at(board, test::board_in_view(board, 80, {0.4, 0.2, 0.1}), 0);
  EXPECT_FALSE(board_pose(corners_mm, {8, good.front()}, kCamera)) << "one corner eight times";
  for (const double value : {std::nan(""), HUGE_VAL, 0.0, 1e30}) {
    auto corners = good;
    for (BoardCorner& corner : corners) corner.pixel.setConstant(value);
    EXPECT_FALSE(board_pose(corners_mm, corners, kCamera)) << value;
  }
}

}  // namespace
}  // namespace handeye
