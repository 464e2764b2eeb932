// SPDX-License-Identifier: BSD-3-Clause
// What the one-step calibration must not answer.
#include <limits>

#include <gtest/gtest.h>

#include "daemon/handeye/perspective/one_step.hpp"
#include "tests/unit/perspective/scene.hpp"

namespace handeye {
namespace {

using test::Scene;

/// The reason; empty when it is accepted.
std::string refusal(const Observations& observations) {
  const auto found = calibrate_perspective(observations, {});
  const auto* refused = std::get_if<PerspectiveRefusal>(&found);
  return refused == nullptr ? "" : refused->reason;
}

TEST(OneStepRefusal, FewerThanThreePositionsAreRefused) {
  Scene scene(false);
  scene.observations.positions.resize(2);
  EXPECT_EQ(refusal(scene.observations), "too_few_positions");
  scene.observations.positions.clear();
  EXPECT_EQ(refusal(scene.observations), "too_few_positions");
}

TEST(OneStepRefusal, TooFewPointsAreRefused) {
  Scene scene(false);
  scene.observations.positions[2].points.resize(5);
  EXPECT_EQ(refusal(scene.observations), "too_few_points");
  Scene plane(true);
  plane.observations.positions[1].points.resize(3);
  EXPECT_EQ(refusal(plane.observations), "too_few_points");
  plane = Scene(true);
  plane.observations.positions[1].points.resize(6);  // one row of the board
  EXPECT_EQ(refusal(plane.observations), "too_few_points");
}

TEST(OneStepRefusal, MotionThatDoesNotDetermineItIsRefused) {
  const auto moved = [](const std::vector<Pose>& hands) {
    Scene scene(false, 140.0, 1);
    for (const Pose& hand : hands) scene.add_position(hand, false);
    return scene.observations;
  };
  const Pose still = Pose::Identity();
  EXPECT_EQ(refusal(moved({still, still})), "insufficient_rotation");
  EXPECT_EQ(
      refusal(moved({make_pose({1, 0, 0, 0}, {5, 0, 0}), make_pose({1, 0, 0, 0}, {0, 9, 0})})),
      "insufficient_rotation");
  const auto about_x = [](double angle_deg) {
    Pose pose = Pose::Identity();
    pose.linear() = exp_so3(Eigen::Vector3d(rad_from_deg(angle_deg), 0, 0));
    return pose;
  };
  EXPECT_EQ(refusal(moved({about_x(3), about_x(-4), about_x(5)})), "single_axis");
}

TEST(OneStepRefusal, HandPosesTheWrongWayRoundAreNoCalibration) {
  Scene scene(false);
  for (ObservedPosition& position : scene.observations.positions) {
    position.hand1_from_hand = position.hand1_from_hand.inverse();
  }
  EXPECT_NE(refusal(scene.observations), "");
}

TEST(OneStepRefusal, AHandInMetresIsRefused) {
  Scene scene(false);
  for (ObservedPosition& position : scene.observations.positions) {
    position.hand1_from_hand.translation() /= 1000.0;
  }
  EXPECT_EQ(refusal(scene.with_image_noise(0.2, 1).observations), "inconsistent");
}

TEST(OneStepRefusal, NumbersThatAreNotFiniteAreRefused) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  Scene scene(false);
  scene.observations.positions[1].points[3].pixel.x() = kNaN;
  EXPECT_EQ(refusal(scene.observations), "unusable_numbers");
  scene = Scene(false);
  scene.observations.positions[2].hand1_from_hand.translation().z() = kNaN;
  EXPECT_EQ(refusal(scene.observations), "unusable_numbers");
  scene = Scene(false);
  scene.observations.positions[2].hand1_from_hand.linear() *= 2.0;
  EXPECT_EQ(refusal(scene.observations), "unusable_numbers");
}

TEST(OneStepRefusal, NumbersThatNothingHasAreRefused) {
  Scene scene(false);
  scene.observations.positions[1].points[3].object_mm.x() = 1e300;
  EXPECT_EQ(refusal(scene.observations), "unusable_numbers");
  scene = Scene(false);
  scene.observations.positions[2].hand1_from_hand.translation().y() = 1e10;
  EXPECT_EQ(refusal(scene.observations), "unusable_numbers");
}

TEST(OneStepRefusal, UnitsThatDoNotMatchAreRefusedWithoutNoise) {
  for (const double factor : {1e-3, 1e3, 1e6}) {
    Scene scene(false);
    for (ObservedPosition& position : scene.observations.positions) {
      for (ObjectPoint& point : position.points) point.object_mm *= factor;
    }
    testing::internal::CaptureStderr();
    EXPECT_NE(refusal(scene.with_image_noise(0.2, 1).observations), "") << factor;
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << factor;
  }
}

/// Turned so little that the noise hides where the hand's origin is; turned further, with the same
/// noise, it is known.
TEST(OneStepRefusal, ATurnThatTheNoiseHidesIsRefused) {
  const auto turned_by = [](double turn_deg) {
    Scene scene(false, 140.0, 1);
    for (const Eigen::Vector3d& axis : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0)}) {
      Pose eye1_from_eye = Pose::Identity();
      eye1_from_eye.linear() = exp_so3(rad_from_deg(turn_deg) * axis);
      scene.add_position(scene.hand_from_eye * eye1_from_eye * scene.hand_from_eye.inverse(),
                         false);
    }
    return refusal(scene.with_image_noise(1.0, 5).observations);
  };
  for (const double turn_deg : {0.3, 0.6, 1.0}) EXPECT_EQ(turned_by(turn_deg), "uncertain");
  EXPECT_EQ(turned_by(12.0), "");
}

TEST(OneStepRefusal, AMirroredImageIsRefused) {
  Scene scene(false);
  for (ObservedPosition& position : scene.observations.positions) {
    for (ObjectPoint& point : position.points) point.pixel.y() = 480.0 - point.pixel.y();
  }
  EXPECT_NE(refusal(scene.observations), "");
}

}  // namespace
}  // namespace handeye
