// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/estimate.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/unit/handeye/parted.hpp"

/// Hand and eye brought together where the reconstruction is in parts.
namespace handeye {
namespace {

constexpr double kOffset_s = 0.030;
constexpr int kFrames = 200;

std::int64_t ns(double time_s) {
  return std::llround(1e9 * time_s);
}

/// The tracker at 60 Hz, exact but for 0.02 deg.
PoseBuffer hand_of(const synthetic::Truth& truth) {
  PoseBuffer hand;
  std::mt19937 generator(3);
  std::normal_distribution<double> turn(0, rad_from_deg(0.02));
  for (int k = 0; k < 600; ++k) {
    const double time_s = k / 60.0;
    HandSample sample{ns(time_s), true,
                      synthetic::free_hand(time_s) * truth.solution.hand_from_eye.inverse()};
    const Eigen::Vector3d error(turn(generator), turn(generator), turn(generator));
    sample.room_from_hand.linear() *= exp_so3(error);
    hand.push(sample);
  }
  return hand;
}

/// Two parts, a scene and a scale each; at the border the camera is elsewhere in another scene.
std::vector<RegisteredFrame> frames_of(const synthetic::Truth& truth) {
  std::vector<HandEyeObservation> seen;
  for (int k = 0; k < kFrames; ++k) {
    HandEyeObservation observation;
    observation.poses.eye_from_scene =
        (truth.room_from_scene.inverse() * synthetic::free_hand(1.0 + k / 25.0)).inverse();
    seen.push_back(observation);
  }
  const auto parted = synthetic::in_parts(seen, truth, {120, 80}, {0.2, 7.0}, 8);
  std::vector<RegisteredFrame> frames;
  for (int k = 0; k < kFrames; ++k) {
    const HandEyeObservation& observation = parted.observations[static_cast<std::size_t>(k)];
    frames.push_back({.index = k,
                      .timestamp_ns = ns(1.0 + k / 25.0 + kOffset_s),
                      .eye_from_scene = observation.poses.eye_from_scene,
                      .part = observation.part});
  }
  return frames;
}

TEST(Estimate, JoinsPartsAtOneTimeOffset) {
  const synthetic::Truth truth = synthetic::scope();
  const PoseBuffer hand = hand_of(truth);
  const Estimate found = estimate(frames_of(truth), hand, {});
  ASSERT_TRUE(found.correlation && found.likelihood);
  EXPECT_NEAR(found.correlation->time_offset_s, kOffset_s, 0.005);
  EXPECT_NEAR(found.time_offset_s, kOffset_s, 0.0005);
  EXPECT_EQ(found.likelihood->parts.size(), 2u);
  EXPECT_EQ(found.likelihood->poses_used, static_cast<std::size_t>(kFrames));
  const Vector6d error =
      synthetic::error_of(found.likelihood->solution.hand_from_eye, truth.solution.hand_from_eye);
  EXPECT_LT(deg_from_rad(error.head<3>().norm()), 0.03);
  EXPECT_LT(error.tail<3>().norm(), 0.2);
}

/// A turn from one scene into another is no turn of the camera.
TEST(Estimate, TakesNoAngularSpeedAcrossParts) {
  const synthetic::Truth truth = synthetic::scope();
  const PoseBuffer hand = hand_of(truth);
  std::vector<RegisteredFrame> frames = frames_of(truth);
  const double peak = estimate(frames, hand, {}).correlation.value().peak;
  for (RegisteredFrame& frame : frames) frame.part = 0;
  const auto mixed = estimate(frames, hand, {}).correlation;
  EXPECT_GT(peak, 0.99);
  EXPECT_TRUE(!mixed || mixed->peak < peak);
}

TEST(Estimate, GivesThePosesOfTheAnswersPart) {
  const synthetic::Truth truth = synthetic::scope();
  const PoseBuffer hand = hand_of(truth);
  const Estimate found = estimate(frames_of(truth), hand, {});
  ASSERT_TRUE(found.likelihood);
  EXPECT_EQ(found.likelihood->part, 0);
  EXPECT_EQ(poses_of_answer(found).size(), 120u);
  const Residuals residuals = seed_residuals(poses_of_answer(found), found.likelihood->solution);
  EXPECT_LT(residuals.rotation_deg, 0.1);
  EXPECT_LT(residuals.translation_percent, 3.0);
}

}  // namespace
}  // namespace handeye
