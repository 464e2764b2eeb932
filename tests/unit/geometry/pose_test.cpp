// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/geometry/pose.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace handeye {
namespace {

/// Directions, some along the axes where quaternion conversions switch branches.
std::vector<Eigen::Vector3d> directions() {
  std::vector<Eigen::Vector3d> result{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, 0, -1}};
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 50; ++i) {
    result.push_back(
        Eigen::Vector3d(normal(generator), normal(generator), normal(generator)).normalized());
  }
  return result;
}

const std::vector<double> kAwkwardAngles{0,    1e-300, 1e-160,  1e-12, 1e-9,       1e-8,      1e-5,
                                         1e-4, 0.3,    kPi / 2, 3.0,   kPi - 1e-4, kPi - 1e-8};

TEST(ExpLog, LogUndoesExpFromZeroToPi) {
  for (const double angle : kAwkwardAngles) {
    for (const Eigen::Vector3d& direction : directions()) {
      const Eigen::Vector3d w = angle * direction;
      EXPECT_LT((log_so3(exp_so3(w)) - w).norm(), 1e-7 * angle + 1e-15)
          << "angle " << angle << " about " << direction.transpose();
    }
  }
}

TEST(ExpLog, LogIsAccurateToRoundingAwayFromPi) {
  for (const double angle : {1e-10, 1e-6, 1e-3, 0.5, 2.0, 3.0}) {
    for (const Eigen::Vector3d& direction : directions()) {
      const Eigen::Vector3d w = angle * direction;
      EXPECT_LT((log_so3(exp_so3(w)) - w).norm(), 1e-14) << angle;
    }
  }
}

TEST(ExpLog, AtPiTheAxisIsRightUpToItsSign) {
  for (const Eigen::Vector3d& direction : directions()) {
    const Eigen::Vector3d w = log_so3(exp_so3(kPi * direction));
    EXPECT_NEAR(w.norm(), kPi, 1e-9);
    EXPECT_NEAR(std::abs(w.dot(direction)), kPi, 1e-9);
  }
}

TEST(ExpLog, ExpGivesRotations) {
  for (const double angle : kAwkwardAngles) {
    for (const Eigen::Vector3d& direction : directions()) {
      const Eigen::Matrix3d rotation = exp_so3(angle * direction);
      EXPECT_LT((rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm(), 1e-14);
      EXPECT_GT(rotation.determinant(), 0.5);
      EXPECT_LT((rotation * direction - direction).norm(), 1e-14);
    }
  }
}

TEST(ExpLog, ExpAgreesWithTheSeriesOfTheMatrixExponential) {
  const Eigen::Vector3d w(0.3, -0.8, 0.4);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d term = Eigen::Matrix3d::Identity();
  for (int k = 1; k < 30; ++k) {
    term = term * skew(w) / k;
    sum += term;
  }
  EXPECT_LT((exp_so3(w) - sum).norm(), 1e-14);
}

TEST(RotationAngle, AgreesWithTheRotationAtBothEnds) {
  for (const double angle : kAwkwardAngles) {
    for (const Eigen::Vector3d& direction : directions()) {
      EXPECT_NEAR(rotation_angle_rad(exp_so3(angle * direction)), angle, 1e-15 + 1e-14 * angle);
    }
  }
}

TEST(RotationAngle, OfTwoRotationsIsSymmetricAndInvariant) {
  const Eigen::Matrix3d a = exp_so3({0.2, 0.5, -1.0});
  const Eigen::Matrix3d b = exp_so3({-0.7, 0.1, 0.4});
  const Eigen::Matrix3d c = exp_so3({1.7, -1.1, 0.9});
  EXPECT_NEAR(rotation_angle_rad(a, b), rotation_angle_rad(b, a), 1e-14);
  EXPECT_NEAR(rotation_angle_rad(a, b), rotation_angle_rad(c * a, c * b), 1e-14);
  EXPECT_NEAR(rotation_angle_rad(a, a), 0, 1e-15);
}

TEST(Skew, IsTheCrossProduct) {
  const Eigen::Vector3d a(1, -2, 3);
  const Eigen::Vector3d b(0.5, 4, -1);
  EXPECT_EQ(skew(a) * b, a.cross(b));
}

TEST(MakePose, NormalisesTheQuaternion) {
  const Pose pose = make_pose(Eigen::Quaterniond(-3, 1, 2, -0.5), {1, 2, 3});
  EXPECT_LT((pose.linear().transpose() * pose.linear() - Eigen::Matrix3d::Identity()).norm(),
            1e-14);
  EXPECT_EQ(pose.translation(), Eigen::Vector3d(1, 2, 3));
  const Pose opposite = make_pose(Eigen::Quaterniond(3, -1, -2, 0.5), {1, 2, 3});
  EXPECT_TRUE(pose.isApprox(opposite, 1e-14));
}

TEST(NearestRotation, LeavesRotationsAlone) {
  for (const double angle : kAwkwardAngles) {
    for (const Eigen::Vector3d& direction : directions()) {
      const Eigen::Matrix3d rotation = exp_so3(angle * direction);
      EXPECT_LT((nearest_rotation(rotation) - rotation).norm(), 1e-14);
    }
  }
}

TEST(NearestRotation, IsProperAlsoForReflectionsAndNoOtherIsNearer) {
  std::mt19937 generator(2);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 100; ++trial) {
    Eigen::Matrix3d matrix;
    for (double& entry : matrix.reshaped()) entry = normal(generator);
    const Eigen::Matrix3d nearest = nearest_rotation(matrix);
    EXPECT_NEAR(nearest.determinant(), 1.0, 1e-12);
    EXPECT_LT((nearest.transpose() * nearest - Eigen::Matrix3d::Identity()).norm(), 1e-13);
    for (const Eigen::Vector3d& direction : directions()) {
      for (const double angle : {1e-3, 0.5, 3.0}) {
        const Eigen::Matrix3d other = nearest * exp_so3(angle * direction);
        EXPECT_LE((nearest - matrix).norm(), (other - matrix).norm() + 1e-12);
      }
    }
  }
}

TEST(Interpolate, MeetsItsEndsAndRunsAtConstantSpeed) {
  const Pose a = make_pose(Eigen::Quaterniond(exp_so3({0.1, 0.2, -0.4})), {10, 20, 30});
  const Pose b = make_pose(Eigen::Quaterniond(exp_so3({1.1, -0.6, 0.4})), {-5, 22, 90});
  EXPECT_TRUE(interpolate(a, b, 0.0).isApprox(a, 1e-14));
  EXPECT_TRUE(interpolate(a, b, 1.0).isApprox(b, 1e-14));
  const double whole = rotation_angle_rad(a.linear(), b.linear());
  for (const double fraction : {-0.5, 0.25, 0.5, 0.9, 1.5}) {
    const Pose between = interpolate(a, b, fraction);
    EXPECT_NEAR(rotation_angle_rad(a.linear(), between.linear()), std::abs(fraction) * whole,
                1e-13);
    EXPECT_LT(
        (between.translation() - a.translation() - fraction * (b.translation() - a.translation()))
            .norm(),
        1e-12);
    EXPECT_TRUE(between.isApprox(interpolate(b, a, 1.0 - fraction), 1e-12));
  }
}

}  // namespace
}  // namespace handeye
