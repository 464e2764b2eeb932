// SPDX-License-Identifier: BSD-3-Clause
// Every sample, value by value. Single lines are put behind `fr 1`.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/dtrack/dtrack_text.hpp"

namespace handeye::dtrack {
namespace {

/// Rotations are printed with six decimals.
constexpr double kPrinted = 2e-6;

Parsed parse_line(const std::string& file) {
  Parsed parsed("fr 1\r\n" + sample(file));
  EXPECT_EQ(parsed.status, ParseStatus::kComplete) << file;
  return parsed;
}

Eigen::Matrix3d rotation_of_angles_deg(double eta, double theta, double phi) {
  return (Eigen::AngleAxisd(rad_from_deg(eta), Eigen::Vector3d::UnitX()) *
          Eigen::AngleAxisd(rad_from_deg(theta), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(rad_from_deg(phi), Eigen::Vector3d::UnitZ()))
      .toRotationMatrix();
}

void expect_pose(const Pose& pose, const Eigen::Matrix3d& rotation,
                 const Eigen::Vector3d& translation) {
  EXPECT_LT((pose.linear() - rotation).cwiseAbs().maxCoeff(), kPrinted) << pose.linear();
  EXPECT_EQ(pose.translation(), translation);
  const Eigen::Matrix3d gram = pose.linear().transpose() * pose.linear();
  EXPECT_LT((gram - Eigen::Matrix3d::Identity()).norm(), 1e-10);
}

void expect_bodies_0_and_2(const Frame& frame) {
  ASSERT_NE(frame.find_body(0), nullptr);
  ASSERT_NE(frame.find_body(2), nullptr);
  EXPECT_TRUE(frame.find_body(0)->tracked);
  EXPECT_EQ(frame.find_body(0)->quality, 1.0);
  expect_pose(frame.find_body(0)->room_from_body, rotation_of_angles_deg(30, -20, 45),
              {412.507, -88.25, 1503.125});
  expect_pose(frame.find_body(2)->room_from_body, rotation_of_angles_deg(-120.5, 10.25, -75.75),
              {-1250, 640.375, 987.062});
}

TEST(DTrackSamples, Fr) {
  const Parsed parsed(sample("fr.txt"));
  EXPECT_EQ(parsed.status, ParseStatus::kComplete);
  EXPECT_EQ(parsed.frame.number, 21854U);
}

TEST(DTrackSamples, Ts) {
  EXPECT_EQ(parse_line("ts.txt").frame.seconds_of_day, 43200.5);
}

TEST(DTrackSamples, Ts2) {
  const auto time = parse_line("ts2.txt").frame.unix_time;
  ASSERT_TRUE(time.has_value());
  EXPECT_EQ(time->seconds, 1735732800U);
  EXPECT_EQ(time->microseconds, 500000U);
  EXPECT_EQ(time->latency_us, 4150U);
}

TEST(DTrackSamples, CalibratedBodies) {
  EXPECT_EQ(parse_line("6dcal.txt").frame.calibrated_bodies, 3);
}

TEST(DTrackSamples, CalibratedHands) {
  EXPECT_EQ(parse_line("glcal.txt").frame.calibrated_hands, 2);
}

TEST(DTrackSamples, Bodies) {
  const Parsed parsed = parse_line("6d.txt");
  EXPECT_EQ(parsed.frame.bodies.size(), 2U);
  EXPECT_EQ(parsed.frame.find_body(1), nullptr);
  expect_bodies_0_and_2(parsed.frame);
  EXPECT_EQ(parsed.frame.bodies[0].inertial_state, -1);
}

TEST(DTrackSamples, NoBodies) {
  EXPECT_TRUE(parse_line("6d_none.txt").frame.bodies.empty());
}

TEST(DTrackSamples, HybridBodies) {
  const Parsed parsed = parse_line("6di.txt");
  ASSERT_EQ(parsed.frame.bodies.size(), 3U);
  expect_bodies_0_and_2(parsed.frame);
  const Body& lost = *parsed.frame.find_body(1);
  EXPECT_FALSE(lost.tracked);
  EXPECT_EQ(lost.inertial_state, 0);
  EXPECT_TRUE(lost.room_from_body.matrix().isIdentity(0));
  EXPECT_EQ(parsed.frame.find_body(0)->inertial_state, 3);
  EXPECT_EQ(parsed.frame.find_body(2)->inertial_state, 1);
  EXPECT_DOUBLE_EQ(parsed.frame.find_body(2)->inertial_drift_rad, rad_from_deg(1.75));
}

TEST(DTrackSamples, BodyCovariance) {
  const Parsed parsed("fr 1\r\n" + sample("6d.txt") + sample("6dcov.txt"));
  ASSERT_EQ(parsed.frame.covariances.size(), 1U);
  const BodyCovariance& body = parsed.frame.covariances[0];
  EXPECT_EQ(body.id, 0);
  EXPECT_EQ(body.reference_point_mm, Eigen::Vector3d(412.51, -88.24, 1503.1));
  Matrix6d upper;
  upper << 1.2e-3, 1e-5, -2e-5, 3e-6, 0, 1e-6,  //
      0, 1.5e-3, 4e-5, 0, 2e-6, 0,              //
      0, 0, 2.1e-3, -1e-6, 0, 3e-6,             //
      0, 0, 0, 4e-6, 0, 1e-7,                   //
      0, 0, 0, 0, 5e-6, 0,                      //
      0, 0, 0, 0, 0, 6e-6;
  const Matrix6d expected = upper.selfadjointView<Eigen::Upper>();
  EXPECT_EQ(body.covariance, expected);
}

TEST(DTrackSamples, Markers) {
  const Parsed parsed = parse_line("3d.txt");
  ASSERT_EQ(parsed.frame.markers.size(), 2U);
  EXPECT_EQ(parsed.frame.markers[0].id, 1);
  EXPECT_EQ(parsed.frame.markers[0].position_mm, Eigen::Vector3d(55.125, -310.75, 1210));
  EXPECT_EQ(parsed.frame.markers[1].id, 17);
  EXPECT_EQ(parsed.frame.markers[1].quality, 0.85);
}

TEST(DTrackSamples, Flysticks) {
  const Parsed parsed = parse_line("6df2.txt");
  ASSERT_EQ(parsed.frame.flysticks.size(), 2U);
  const Flystick& tracked = parsed.frame.flysticks[0];
  EXPECT_TRUE(tracked.tracked);
  expect_pose(tracked.room_from_body, rotation_of_angles_deg(15, 40, -60),
              {101.5, 202.25, 1303.75});
  EXPECT_EQ(tracked.buttons, (std::vector<bool>{true, false, true, false, false, false}));
  EXPECT_EQ(tracked.joysticks, (std::vector<double>{0.5, -0.25}));
  const Flystick& untracked = parsed.frame.flysticks[1];
  EXPECT_FALSE(untracked.tracked);
  EXPECT_TRUE(untracked.room_from_body.matrix().isIdentity(0));
  EXPECT_TRUE(untracked.buttons.empty());
  EXPECT_TRUE(untracked.joysticks.empty());
}

TEST(DTrackSamples, OldFlysticks) {
  const Parsed parsed = parse_line("6df.txt");
  ASSERT_EQ(parsed.frame.flysticks.size(), 1U);
  const Flystick& flystick = parsed.frame.flysticks[0];
  expect_pose(flystick.room_from_body, rotation_of_angles_deg(15, 40, -60),
              {101.5, 202.25, 1303.75});
  EXPECT_EQ(flystick.buttons, (std::vector<bool>{true, false, false, false}));  // 33 = 1 + left
  EXPECT_EQ(flystick.joysticks, (std::vector<double>{-1, 0}));
}

TEST(DTrackSamples, Tools) {
  const Parsed parsed = parse_line("6dmt2.txt");
  ASSERT_EQ(parsed.frame.tools.size(), 2U);
  const MeasurementTool& tool = parsed.frame.tools[0];
  EXPECT_TRUE(tool.tracked);
  EXPECT_EQ(tool.tip_radius_mm, 2.0);
  EXPECT_EQ(tool.buttons, (std::vector<bool>{true, true, false, false}));
  EXPECT_EQ(tool.room_from_tool.translation(), Eigen::Vector3d(250.125, -40.5, 810));
  EXPECT_EQ(tool.room_from_tool.linear().col(0), Eigen::Vector3d(0, 0, -1));
  Eigen::Matrix3d covariance;
  covariance << 1.1e-3, 2e-5, -1e-5, 2e-5, 1.3e-3, 4e-5, -1e-5, 4e-5, 1.9e-3;
  EXPECT_EQ(tool.tip_covariance_mm2, covariance);
  EXPECT_FALSE(parsed.frame.tools[1].tracked);
  EXPECT_EQ(parsed.frame.tools[1].buttons.size(), 4U);
}

TEST(DTrackSamples, OldTools) {
  const Parsed parsed = parse_line("6dmt.txt");
  ASSERT_EQ(parsed.frame.tools.size(), 1U);
  EXPECT_TRUE(parsed.frame.tools[0].tracked);
  EXPECT_TRUE(parsed.frame.tools[0].buttons.empty());
  EXPECT_EQ(parsed.frame.tools[0].room_from_tool.translation(),
            Eigen::Vector3d(250.125, -40.5, 810));
}

TEST(DTrackSamples, ToolReferences) {
  const Parsed parsed = parse_line("6dmtr.txt");
  ASSERT_EQ(parsed.frame.tool_references.size(), 1U);
  EXPECT_EQ(parsed.frame.tool_references[0].id, 1);
  expect_pose(parsed.frame.tool_references[0].room_from_reference, rotation_of_angles_deg(0, 0, 30),
              {300, 0, 750.5});
}

TEST(DTrackSamples, Hand) {
  const Parsed parsed = parse_line("gl.txt");
  ASSERT_EQ(parsed.frame.hands.size(), 1U);
  const FingertrackingHand& hand = parsed.frame.hands[0];
  EXPECT_EQ(hand.id, 1);
  EXPECT_FALSE(hand.right);
  EXPECT_EQ(hand.room_from_hand_back.translation(), Eigen::Vector3d(-150.5, 420.25, 1050));
  ASSERT_EQ(hand.fingers.size(), 3U);
  const Finger& thumb = hand.fingers[0];
  EXPECT_EQ(thumb.hand_from_fingertip.translation(), Eigen::Vector3d(35.5, -40.2, -8.1));
  EXPECT_NEAR(thumb.hand_from_fingertip(0, 1), -0.0790, 5e-4);
  EXPECT_EQ(thumb.tip_radius_mm, 9.5);
  EXPECT_EQ(thumb.phalanx_length_mm, (std::array<double, 3>{24.0, 31.5, 45.0}));
  EXPECT_DOUBLE_EQ(thumb.joint_angle_rad[0], rad_from_deg(-18.0));
  EXPECT_DOUBLE_EQ(thumb.joint_angle_rad[1], rad_from_deg(-12.5));
  EXPECT_EQ(hand.fingers[2].phalanx_length_mm[2], 48.0);
}

TEST(DTrackSamples, Human) {
  const Parsed parsed = parse_line("6dj.txt");
  ASSERT_EQ(parsed.frame.humans.size(), 1U);
  ASSERT_EQ(parsed.frame.humans[0].joints.size(), 2U);
  const Joint& joint = parsed.frame.humans[0].joints[1];
  EXPECT_EQ(joint.id, 1);
  EXPECT_TRUE(joint.tracked);
  EXPECT_EQ(joint.room_from_joint.translation(), Eigen::Vector3d(12.5, 20, 1180));
  EXPECT_NEAR(joint.room_from_joint(0, 0), -0.951251, kPrinted);
  EXPECT_DOUBLE_EQ(joint.relative_angle_rad[2], rad_from_deg(170.0));
}

TEST(DTrackSamples, Status) {
  const auto status = parse_line("st.txt").frame.system_status;
  ASSERT_TRUE(status.has_value());
  EXPECT_EQ(status->cameras, 2);
  EXPECT_EQ(status->bodies, 2);
  EXPECT_EQ(status->markers, 5);
  EXPECT_EQ(status->camera_errors, 0);
  EXPECT_EQ(status->camera_warnings, 1);
  EXPECT_EQ(status->infos, 7);
  ASSERT_EQ(status->camera_status.size(), 2U);
  EXPECT_EQ(status->camera_status[1].id, 1);
  EXPECT_EQ(status->camera_status[1].reflections, 9);
  EXPECT_EQ(status->camera_status[1].reflections_used, 6);
  EXPECT_EQ(status->camera_status[1].max_intensity, 6);
}

TEST(DTrackSamples, FullFrame) {
  const Parsed parsed(sample("full_frame.txt"));
  EXPECT_EQ(parsed.status, ParseStatus::kComplete);
  EXPECT_EQ(parsed.counters().warnings, decltype(ParseCounters::warnings){});
  EXPECT_EQ(parsed.counters().lines, 14U);
  const Frame& frame = parsed.frame;
  EXPECT_EQ(frame.number, 21854U);
  EXPECT_EQ(frame.calibrated_bodies, 3);  // new device formats are not counted in
  ASSERT_EQ(frame.bodies.size(), 3U);
  expect_bodies_0_and_2(frame);
  EXPECT_EQ(frame.find_body(2)->inertial_state, 1);
  EXPECT_EQ(frame.covariances.size(), 1U);
  EXPECT_EQ(frame.flysticks.size(), 2U);
  EXPECT_EQ(frame.markers.size(), 2U);
  EXPECT_EQ(frame.tools.size(), 2U);
  EXPECT_EQ(frame.tool_references.size(), 1U);
  EXPECT_EQ(frame.calibrated_hands, 2);
  EXPECT_EQ(frame.hands.size(), 1U);
  EXPECT_EQ(frame.humans.size(), 1U);
  EXPECT_TRUE(frame.system_status.has_value());
}

TEST(DTrackSamples, DTrack1Frame) {
  const Parsed parsed(sample("dtrack1_frame.txt"));
  EXPECT_EQ(parsed.status, ParseStatus::kComplete);
  EXPECT_EQ(parsed.frame.calibrated_bodies, 3);  // 5 less one Flystick and one tool
  expect_bodies_0_and_2(parsed.frame);
  EXPECT_EQ(parsed.frame.flysticks.size(), 1U);
  EXPECT_EQ(parsed.frame.tools.size(), 1U);
}

}  // namespace
}  // namespace handeye::dtrack
