// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/selection.hpp"

#include <algorithm>
#include <random>
#include <set>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "tests/unit/handeye/synthetic.hpp"

namespace handeye {
namespace {

std::vector<PosePair> free_hand(int count, std::uint32_t seed = 1) {
  return synthetic::record(synthetic::scope(), synthetic::free_hand, count,
                           synthetic::tracker_and_camera(), seed)
      .poses();
}

double angle_deg(const Movement& movement) {
  return deg_from_rad(rotation_angle_rad(movement.hand_j_from_hand_i.linear()));
}

TEST(Movements, AreWhatTheirNamesSay) {
  const auto poses = free_hand(2);
  const Movement movement = movement_between(poses[0], poses[1]);
  EXPECT_TRUE((poses[1].room_from_hand * movement.hand_j_from_hand_i)
                  .isApprox(poses[0].room_from_hand, 1e-12));
  EXPECT_TRUE((movement.eye_j_from_eye_i * poses[0].eye_from_scene)
                  .isApprox(poses[1].eye_from_scene, 1e-12));
}

TEST(Selection, IsBoundedHoweverLongTheSequence) {
  EXPECT_LE(select_movements(free_hand(100)).movements.size(), 500U);
  const auto movements = select_movements(free_hand(1500)).movements;
  EXPECT_LE(movements.size(), 500U);
  EXPECT_GT(movements.size(), 300U);
}

TEST(Selection, TakesLargeAnglesAboutAllAxes) {
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Movement& movement : select_movements(free_hand(300)).movements) {
    EXPECT_GE(angle_deg(movement), 15.0);
    EXPECT_LE(angle_deg(movement), 175.0);
    const Eigen::Vector3d axis = log_so3(movement.hand_j_from_hand_i.linear()).normalized();
    scatter += axis * axis.transpose();
  }
  const Eigen::Vector3d spread =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvalues();
  EXPECT_GT(spread[0], 0.1 * spread.sum());
}

TEST(Selection, LowersTheSmallestAngleWhenTooFewAreLarger) {
  std::mt19937 generator(2);
  const auto poses = synthetic::random_poses(synthetic::scope(), generator, 20, rad_from_deg(4));
  const auto movements = select_movements(poses).movements;
  EXPECT_GE(movements.size(), 50U);
  for (const Movement& movement : movements) EXPECT_GE(angle_deg(movement), 1.0);
}

TEST(Selection, LeavesOutWhatDoesNotTurnAlike) {
  auto poses = free_hand(100);
  for (std::size_t k = 10; k < poses.size(); k += 10) {
    poses[k].eye_from_scene.linear() *= exp_so3({0.3, 0.2, 0});
  }
  for (const Movement& movement : select_movements(poses).movements) {
    const double eye_deg = deg_from_rad(rotation_angle_rad(movement.eye_j_from_eye_i.linear()));
    EXPECT_LT(std::abs(eye_deg - angle_deg(movement)), 2.0);
  }
}

TEST(Selection, UsesPosesEvenly) {
  const auto poses = free_hand(100);
  const Selection selection = select_movements(poses);
  std::vector<std::size_t> uses(poses.size(), 0);
  for (const auto& [i, j] : selection.pairs) {
    EXPECT_LT(i, j);
    ++uses[i];
    ++uses[j];
  }
  // 500 movements of 100 poses: ten each, less where few large angles begin.
  EXPECT_LE(*std::max_element(uses.begin(), uses.end()), 20U);
  EXPECT_GE(std::count_if(uses.begin(), uses.end(), [](std::size_t n) { return n >= 5; }), 90);
}

TEST(Selection, LeavesWrongPosesOutAltogether) {
  auto poses = free_hand(100);
  const std::vector<std::size_t> wrong{5, 17, 18, 19, 60, 99};
  for (const std::size_t k : wrong) poses[k].eye_from_scene.translation().x() += 40;
  const Selection selection = select_movements(poses);
  EXPECT_EQ(selection.wrong_poses, wrong);
  for (const auto& [i, j] : selection.pairs) {
    EXPECT_FALSE(std::binary_search(wrong.begin(), wrong.end(), i));
    EXPECT_FALSE(std::binary_search(wrong.begin(), wrong.end(), j));
  }
}

TEST(Selection, LooksAtAsManyPosesAsItMayOfALongSequence) {
  const Selection selection = select_movements(free_hand(330));
  std::set<std::size_t> poses;
  for (const auto& [i, j] : selection.pairs) poses.insert({i, j});
  EXPECT_GT(poses.size(), 180U);
  EXPECT_LE(poses.size(), 200U);
  EXPECT_GT(*poses.rbegin(), 300U);
}

TEST(Selection, IsTheSameEveryTime) {
  const auto a = select_movements(free_hand(300)).movements;
  const auto b = select_movements(free_hand(300)).movements;
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].hand_j_from_hand_i.matrix(), b[k].hand_j_from_hand_i.matrix());
  }
}

TEST(Selection, OfNothingIsNothing) {
  EXPECT_TRUE(select_movements({}).movements.empty());
  EXPECT_TRUE(select_movements(free_hand(1)).movements.empty());
}

}  // namespace
}  // namespace handeye
