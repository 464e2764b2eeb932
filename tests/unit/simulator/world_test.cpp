// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/world.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "drivers/simulator/truth_file.hpp"

namespace handeye::simulator {
namespace {

constexpr std::int64_t kStartNs = 5'000'000'000;

TEST(World, FramesFitTogether) {
  SimulatorOptions options;
  options.seed = 31;
  const World world(options, kStartNs);
  for (const double time_s : {0.0, 4.2, 17.0, 3600.0}) {
    EXPECT_TRUE((world.room_from_hand(time_s) * world.hand_from_eye)
                    .isApprox(world.room_from_eye(time_s), 1e-12));
    // The optical axis meets the surface some 80 mm ahead.
    const Pose surface_from_eye = world.room_from_surface.inverse() * world.room_from_eye(time_s);
    const auto distance_mm = world.surface.intersect(surface_from_eye.translation(),
                                                     surface_from_eye.linear().col(2), 1000.0);
    ASSERT_TRUE(distance_mm.has_value());
    EXPECT_GT(*distance_mm, 50.0);
    EXPECT_LT(*distance_mm, 120.0);
  }
}

TEST(World, DrawsWithinTheDocumentedRanges) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    SimulatorOptions options;
    options.seed = seed;
    const World world(options, kStartNs);
    const Eigen::Vector3d hand_in_eye = world.hand_from_eye.inverse().translation();
    EXPECT_NEAR(hand_in_eye.norm(), 300.0, 15.0);
    EXPECT_LT(hand_in_eye.z(), -280.0 * std::cos(rad_from_deg(15.0)));
    EXPECT_FALSE(world.camera.problem().has_value());
    EXPECT_NEAR(world.camera.fx, 600.0, 15.0);
    EXPECT_GE(world.tracker_latency_s, 0.005);
    EXPECT_LE(world.tracker_latency_s, 0.025);
    EXPECT_GE(world.camera_delay_s, 0.010);
    EXPECT_LE(world.camera_delay_s, 0.060);
    EXPECT_LE(std::abs(world.tracker_clock_drift), 50e-6);
  }
}

TEST(World, MotionAndLensDoNotDependOnRatesAndNoise) {
  SimulatorOptions options;
  options.seed = 12;
  const World world(options, kStartNs);
  options.camera_rate_hz = 50;
  options.tracker_noise_mm = 0;
  options.body_id = 4;
  const World other(options, 0);
  EXPECT_TRUE(world.room_from_hand(3.3).isApprox(other.room_from_hand(3.3), 0.0));
  EXPECT_TRUE(world.hand_from_eye.isApprox(other.hand_from_eye, 0.0));
  EXPECT_EQ(world.camera.fx, other.camera.fx);
  EXPECT_EQ(world.time_offset_s(), other.time_offset_s());

  options.seed = 13;
  const World third(options, 0);
  EXPECT_FALSE(world.hand_from_eye.isApprox(third.hand_from_eye, 1e-3));
}

TEST(World, TurnsNoFurtherThanChosen) {
  SimulatorOptions options;
  options.seed = 12;
  options.largest_turn_deg = 4;
  options.largest_shift_mm = 0;
  const World world(options, kStartNs);
  const Eigen::Matrix3d straight_down = Eigen::Vector3d(1, -1, -1).asDiagonal();
  double largest_deg = 0;
  for (int tenth = 0; tenth < 300; ++tenth) {
    const Eigen::Matrix3d now = world.motion.surface_from_eye(0.1 * tenth).linear();
    const Eigen::Vector3d turn_rad = log_so3(straight_down.transpose() * now);
    largest_deg = std::max(largest_deg, deg_from_rad(turn_rad.cwiseAbs().maxCoeff()));
  }
  EXPECT_LE(largest_deg, 4.0 + 1e-9);
  EXPECT_GT(largest_deg, 3.8);
}

TEST(World, TrackerClockDriftsAndFallsBackAtMidnight) {
  SimulatorOptions options;
  options.seed = 3;
  World world(options, kStartNs);
  world.tracker_clock_start_s = 86'390.0;
  world.tracker_clock_drift = 40e-6;
  EXPECT_NEAR(world.tracker_clock_s(5.0), 86'395.0002, 1e-9);
  EXPECT_NEAR(world.tracker_clock_s(20.0), 10.0008, 1e-9);
}

TEST(World, TruthIsSaidInTheResultsNames) {
  SimulatorOptions options;
  options.seed = 3;
  options.motion = MotionKind::kPivot;
  const World world(options, kStartNs);
  const auto truth = truth_json(world);
  const auto q = truth.at("hand_from_eye").at("q_wxyz").get<std::vector<double>>();
  const auto t = truth.at("hand_from_eye").at("t_mm").get<std::vector<double>>();
  ASSERT_EQ(q.size(), 4U);
  ASSERT_EQ(t.size(), 3U);
  EXPECT_GE(q[0], 0.0);
  const Pose hand_from_eye =
      make_pose(Eigen::Quaterniond(q[0], q[1], q[2], q[3]), {t[0], t[1], t[2]});
  EXPECT_TRUE(hand_from_eye.isApprox(world.hand_from_eye, 1e-12));
  EXPECT_DOUBLE_EQ(
      truth.at("time_offset_s").get<double>(),
      truth.at("camera_delay_s").get<double>() - truth.at("tracker_latency_s").get<double>());
  EXPECT_EQ(truth.at("camera").at("source"), "given");
  EXPECT_EQ(truth.at("camera").at("distortion").size(), 5U);
  EXPECT_EQ(truth.at("seed"), 3U);
  EXPECT_EQ(truth.at("motion"), "pivot");
}

}  // namespace
}  // namespace handeye::simulator
