// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/selection.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "tests/unit/handeye/spoiled.hpp"
#include "tests/unit/handeye/synthetic.hpp"
#include "tests/unit/handeye/tables.hpp"

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

/// Sixteen poses in four attitudes half a turn apart, and one turned by 2 degrees against one of
/// them: within 175 degrees there is nothing but movements of 2 degrees.
std::vector<PosePair> in_four_attitudes(const synthetic::Truth& truth, std::mt19937& generator) {
  std::normal_distribution<double> normal;
  const auto normal3 = [&] {
    const double x = normal(generator);
    const double y = normal(generator);
    return Eigen::Vector3d(x, y, normal(generator));
  };
  std::vector<PosePair> poses;
  for (int k = 0; k < 17; ++k) {
    Eigen::Vector3d turn = Eigen::Vector3d::Zero();
    if (k % 4 > 0) turn[k % 4 - 1] = kPi;
    if (k == 16) turn.setConstant(rad_from_deg(2) / std::sqrt(3.0));
    PosePair pair;
    pair.room_from_hand.linear() = exp_so3(turn);
    pair.room_from_hand.translation() = 100 * normal3();
    pair.eye_from_scene = truth.solution.hand_from_eye.inverse() * pair.room_from_hand.inverse() *
                          truth.room_from_scene;
    pair.eye_from_scene.translation() *= truth.solution.scale_units_per_mm;
    poses.push_back(pair);
  }
  synthetic::add_noise(poses, synthetic::tracker_and_camera(), truth.solution.scale_units_per_mm,
                       generator);
  return poses;
}

TEST(Selection, TakesHalfTurnsRatherThanAFewSmallOnes) {
  std::mt19937 generator(7);
  for (const ScaleMode mode : tables::kModes) {
    for (int trial = 0; trial < 20; ++trial) {
      const auto truth = synthetic::random_truth(generator, tables::scale_in(mode, 0.02));
      const auto poses = in_four_attitudes(truth, generator);
      const Selection selection = select_movements(poses, {.scale = mode});
      EXPECT_GE(selection.movements.size(), 50U);
      for (const Method& method : methods(mode)) {
        const auto found = method.solve({.poses = poses, .movements = selection.movements});
        ASSERT_TRUE(found) << tables::label(method, mode);
        const Vector6d error =
            synthetic::error_of(found->hand_from_eye, truth.solution.hand_from_eye);
        EXPECT_LT(deg_from_rad(error.head<3>().norm()), 0.3) << tables::label(method, mode);
        EXPECT_LT(error.tail<3>().norm(), 3.0) << tables::label(method, mode);
        EXPECT_NEAR(found->scale_units_per_mm / truth.solution.scale_units_per_mm, 1.0, 0.02)
            << tables::label(method, mode);
      }
    }
  }
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
