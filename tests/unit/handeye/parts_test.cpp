// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "daemon/handeye/movements_within_parts.hpp"
#include "tests/unit/handeye/parted.hpp"

/// A reconstruction in several parts: exact answers, and what counts.
namespace handeye {
namespace {

using synthetic::free_hand;
using synthetic::in_parts;
using synthetic::record;
using synthetic::scope;
using synthetic::tracker_and_camera;

constexpr PoseNoise kExact{0, 0, 0, 0};

double error_of(const MaximumLikelihoodResult& found) {
  return synthetic::error_of(found.solution.hand_from_eye, scope().solution.hand_from_eye).norm();
}

void expect_exact(const std::vector<HandEyeObservation>& observations,
                  const std::vector<synthetic::PartTruth>& truth) {
  const auto found = maximum_likelihood(observations);
  ASSERT_TRUE(found);
  EXPECT_LT(error_of(*found), 1e-7);
  EXPECT_EQ(found->poses_used, observations.size());
  ASSERT_EQ(found->parts.size(), truth.size());
  for (const PartResult& part : found->parts) {
    const synthetic::PartTruth& wanted = truth[static_cast<std::size_t>(part.number)];
    EXPECT_EQ(part.poses_used, wanted.poses);
    EXPECT_NEAR(part.scale_units_per_mm / wanted.scale_units_per_mm, 1.0, 1e-9);
    EXPECT_LT(synthetic::error_of(part.room_from_scene, wanted.room_from_scene).norm(), 1e-6);
  }
}

TEST(Parts, OfAnyScaleGiveTheExactAnswer) {
  const auto recording = record(scope(), free_hand, 150, kExact, 1);
  const auto two = in_parts(recording.observations, scope(), {90, 60}, {0.2, 7.0}, 1);
  expect_exact(two.observations, two.parts);
  const auto three = in_parts(recording.observations, scope(), {40, 60, 50}, {7.0, 1.0, 0.2}, 2);
  expect_exact(three.observations, three.parts);
}

/// The scene of the first is found again after the second.
TEST(Parts, MayTakeTurns) {
  const auto recording = record(scope(), free_hand, 150, kExact, 1);
  auto parted = in_parts(recording.observations, scope(), {50, 50, 50}, {0.2, 7.0, 0.2}, 3);
  const Pose third_from_first =
      parted.parts[2].room_from_scene.inverse() * parted.parts[0].room_from_scene;
  for (auto& observation : parted.observations) {
    if (observation.part != 2) continue;
    Pose& eye = observation.poses.eye_from_scene;
    eye.translation() /= 0.2;
    eye = eye * third_from_first;
    eye.translation() *= 0.2;
    observation.part = 0;
  }
  parted.parts[0].poses += parted.parts[2].poses;
  parted.parts.pop_back();
  expect_exact(parted.observations, parted.parts);
}

TEST(Parts, HaveNamesOnly) {
  auto observations = record(scope(0.07), free_hand, 100, tracker_and_camera(), 4).observations;
  const auto as_zero = maximum_likelihood(observations);
  for (auto& observation : observations) observation.part = -3;
  const auto as_other = maximum_likelihood(observations);
  ASSERT_TRUE(as_zero && as_other);
  EXPECT_EQ(as_other->part, -3);
  EXPECT_TRUE(as_zero->solution.hand_from_eye.matrix() ==
              as_other->solution.hand_from_eye.matrix());
  EXPECT_TRUE(as_zero->covariance == as_other->covariance);
}

/// About one axis in each part: none determines the answer, all together do.
TEST(Parts, DetermineTogetherWhatNoneDoesAlone) {
  std::vector<HandEyeObservation> observations;
  for (int p = 0; p < 3; ++p) {
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(p);
    const auto about_axis = [&](double time_s) {
      Pose pose = free_hand(time_s);
      const Eigen::Matrix3d straight = exp_so3({2.0, 0.3, -0.2});
      const Eigen::Vector3d turn = log_so3(straight.transpose() * pose.linear());
      pose.linear() = straight * exp_so3(axis * axis.dot(turn));
      return pose;
    };
    const auto stretch =
        record(scope(), about_axis, 80, tracker_and_camera(), static_cast<std::uint32_t>(p))
            .observations;
    auto parted =
        in_parts(stretch, scope(), {80}, {p == 1 ? 0.2 : 7.0}, static_cast<std::uint32_t>(p));
    const auto alone = maximum_likelihood(parted.observations);
    EXPECT_TRUE(!alone || alone->sigma_translation_mm() > 5.0);
    for (auto& observation : parted.observations) {
      observation.part = p;
      observations.push_back(observation);
    }
  }
  const auto found = maximum_likelihood(observations);
  ASSERT_TRUE(found);
  EXPECT_LT(found->sigma_rotation_deg(), 0.1);
  EXPECT_LT(found->sigma_translation_mm(), 1.0);
  const Vector6d error =
      synthetic::error_of(found->solution.hand_from_eye, scope().solution.hand_from_eye);
  EXPECT_LT(error.dot(found->covariance.ldlt().solve(error)), 22.5) << "once in a thousand";
}

TEST(Parts, OfTooFewPosesDoNotCount) {
  const auto recording = record(scope(), free_hand, 110, tracker_and_camera(), 5);
  const auto parted =
      in_parts(recording.observations, scope(), {100, 4, 3, 1}, {0.2, 1.0, 7.0, 1.0}, 5);
  const auto found = maximum_likelihood(parted.observations);
  const auto without = maximum_likelihood(synthetic::only(parted.observations, 0));
  ASSERT_TRUE(found && without);
  EXPECT_EQ(found->poses_used, 100u);
  EXPECT_EQ(found->rejected, (std::vector<std::size_t>{100, 101, 102, 103, 104, 105, 106, 107}));
  // But for the mean of all hand poses, which the room is counted from.
  EXPECT_LT(
      synthetic::error_of(found->solution.hand_from_eye, without->solution.hand_from_eye).norm(),
      1e-9);
  EXPECT_TRUE(found->covariance.isApprox(without->covariance, 1e-5));

  EXPECT_FALSE(maximum_likelihood(
      in_parts(recording.observations, scope(), {2, 2, 2, 2}, {1, 1, 1, 1}, 6).observations));
}

/// Together they hold more poses than the part that counts.
TEST(Parts, OfTooFewPosesDoNotHideTheOneThatCounts) {
  const auto recording = record(scope(), free_hand, 28, kExact, 1);
  const auto parted =
      in_parts(recording.observations, scope(), {12, 4, 4, 4, 4}, {0.2, 1, 7, 1, 7}, 1);
  const auto found = maximum_likelihood(parted.observations);
  ASSERT_TRUE(found);
  EXPECT_LT(error_of(*found), 1e-6);
  EXPECT_EQ(found->poses_used, 12u);
}

/// The largest part does not turn: its scale is to be had from its path alone.
TEST(Parts, MayTurnInASmallerOneOnly) {
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    const auto shifted = in_parts(
        record(scope(), synthetic::translation_only, 100, tracker_and_camera(), seed).observations,
        scope(), {100}, {7.0}, seed);
    auto turned =
        in_parts(record(scope(), free_hand, 60, tracker_and_camera(), seed + 10).observations,
                 scope(), {60}, {0.02}, seed + 10);
    auto observations = shifted.observations;
    for (auto& observation : turned.observations) {
      observation.part = 1;
      observations.push_back(observation);
    }
    const auto within = movements_within_parts(observations, ScaleMode::kUnknown);
    EXPECT_EQ(within.unit_part, 1u);
    EXPECT_FALSE(within.movements.empty());
    const auto found = maximum_likelihood(observations);
    ASSERT_TRUE(found);
    ASSERT_EQ(found->parts.size(), 2u);
    EXPECT_NEAR(found->parts[0].scale_units_per_mm / 7.0, 1.0, 0.01);
    EXPECT_NEAR(found->parts[1].scale_units_per_mm / 0.02, 1.0, 0.01);
    EXPECT_LT(error_of(*found), 2.0);
  }
}

TEST(Parts, ShareTheTimeOffset) {
  for (const double offset_s : {-0.012, 0.004}) {
    const auto recording = record(scope(), free_hand, 200, tracker_and_camera(), 6, offset_s);
    const auto parted = in_parts(recording.observations, scope(), {120, 80}, {0.2, 7.0}, 6);
    const auto found = maximum_likelihood(parted.observations, {.estimate_time_offset = true});
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->time_offset_correction_s, offset_s,
                3.5 * found->time_offset_sigma_s + 0.05 * std::abs(offset_s));
    EXPECT_LT(found->time_offset_sigma_s, 0.0005);
  }
}

}  // namespace
}  // namespace handeye
