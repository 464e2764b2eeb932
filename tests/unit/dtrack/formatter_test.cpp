// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dtrack/formatter.hpp"

#include <random>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "drivers/dtrack/blocks.hpp"
#include "tests/unit/dtrack/dtrack_text.hpp"

namespace handeye::dtrack {
namespace {

Eigen::Matrix3d rotation_of_angles(const Eigen::Vector3d& angles_rad) {
  return (Eigen::AngleAxisd(angles_rad[0], Eigen::Vector3d::UnitX()) *
          Eigen::AngleAxisd(angles_rad[1], Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(angles_rad[2], Eigen::Vector3d::UnitZ()))
      .toRotationMatrix();
}

TEST(DTrackFormatter, WritesWhatAControllerWrites) {
  const std::string expected = sample("fr.txt") + sample("ts.txt") + sample("ts2.txt") +
                               sample("6dcal.txt") + sample("6d.txt") + sample("3d.txt");
  const Parsed parsed(expected);
  std::string text = "left from before";
  format_datagram(parsed.frame, text);
  EXPECT_EQ(text, expected);
}

TEST(DTrackFormatter, BodiesThatAreNotTrackedAreAbsent) {
  Frame frame;
  frame.number = 7;
  frame.bodies.resize(2);
  std::string text;
  format_datagram(frame, text);
  EXPECT_EQ(text, "fr 7\r\n6d 0\r\n");
}

TEST(DTrackFormatter, RoundTripOfRandomPoses) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> position_mm(-4000, 4000);
  Parser parser;
  Frame sent;
  Frame received;
  std::string text;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    sent.number = i * 1'000'003U;
    sent.seconds_of_day = std::uniform_real_distribution<double>(0, 86'399.9)(random);
    sent.calibrated_bodies = 3;
    sent.bodies.resize(2);
    for (int id = 0; id < 2; ++id) {
      Body& body = sent.bodies[static_cast<std::size_t>(id)];
      body.id = 2 * id;
      body.tracked = true;
      body.quality = 1.0;
      const Eigen::Vector3d translation(position_mm(random), position_mm(random),
                                        position_mm(random));
      const Eigen::Vector4d q =
          Eigen::Vector4d::NullaryExpr([&] { return std::normal_distribution<double>()(random); });
      body.room_from_body = make_pose(Eigen::Quaterniond(q), translation);
    }
    format_datagram(sent, text);
    ASSERT_EQ(parser.parse(text, received), ParseStatus::kComplete) << text;
    EXPECT_EQ(received.number, sent.number);
    EXPECT_NEAR(*received.seconds_of_day, *sent.seconds_of_day, 0.51e-6);
    EXPECT_EQ(received.calibrated_bodies, 3);
    ASSERT_EQ(received.bodies.size(), 2U);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(received.bodies[k].id, sent.bodies[k].id);
      const Eigen::Matrix4d difference =
          received.bodies[k].room_from_body.matrix() - sent.bodies[k].room_from_body.matrix();
      EXPECT_LT(difference.topLeftCorner(3, 3).cwiseAbs().maxCoeff(), 1.2e-6);
      EXPECT_LT(difference.col(3).cwiseAbs().maxCoeff(), 0.51e-3);
    }
  }
}

TEST(DTrackFormatter, EulerAnglesFollowTheVendorsOrder) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> full(-kPi, kPi);
  std::uniform_real_distribution<double> half(-1.57, 1.57);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d angles_rad(full(random), half(random), full(random));
    EXPECT_LT((euler_angles_rad(rotation_of_angles(angles_rad)) - angles_rad).norm(), 1e-9);
  }
}

TEST(DTrackFormatter, EulerAnglesWhereTheyAreNotUnique) {
  for (const double theta : {kPi / 2, -kPi / 2}) {
    for (const double phi : {-3.0, -1.0, 0.0, 0.5, 3.0}) {
      const Eigen::Matrix3d rotation = rotation_of_angles({0.7, theta, phi});
      EXPECT_LT((rotation_of_angles(euler_angles_rad(rotation)) - rotation).norm(), 1e-7);
    }
  }
}

TEST(DTrackFormatter, PrintedPosesMustBeRotations) {
  Pose pose = Pose::Identity();
  EXPECT_FALSE(make_pose_of_printed(Eigen::Matrix3d::Zero(), {1, 2, 3}, pose));
  EXPECT_FALSE(make_pose_of_printed(-Eigen::Matrix3d::Identity(), {1, 2, 3}, pose));
  EXPECT_TRUE(pose.matrix().isIdentity(0));
  EXPECT_TRUE(make_pose_of_printed(Eigen::Matrix3d::Identity(), {1, 2, 3}, pose));
}

}  // namespace
}  // namespace handeye::dtrack
