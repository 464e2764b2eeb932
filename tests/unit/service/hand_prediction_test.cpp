// SPDX-License-Identifier: BSD-3-Clause
// predict_hand on courses it can follow, and where it must not follow any.
#include "daemon/sync/hand_prediction.hpp"

#include <gtest/gtest.h>

#include "tests/unit/service/hand_samples.hpp"

namespace handeye {
namespace {

using hand_samples::kMillisecond_ns;
using hand_samples::kNoise;
using hand_samples::kRate_hz;
using hand_samples::ns;
using hand_samples::sample;

HandSample hidden_sample(double time_s) {
  HandSample result;
  result.timestamp_ns = ns(time_s);
  return result;
}

/// Turns and moves with constant acceleration about one axis.
Pose accelerated(double time_s) {
  Pose pose = make_pose(Eigen::Quaterniond(0.3, 0.8, -0.1, 0.5), Eigen::Vector3d(1200, -300, 800));
  const double angle = 0.4 * time_s + 0.3 * time_s * time_s;
  pose.linear() = exp_so3(angle * Eigen::Vector3d(0.6, -0.8, 0)) * pose.linear();
  pose.translation() +=
      Eigen::Vector3d(150, -80, 20) * time_s + Eigen::Vector3d(60, 200, -100) * time_s * time_s;
  return pose;
}

PoseBuffer samples_of(Pose (*pose_at)(double), int count) {
  PoseBuffer buffer;
  for (int i = 0; i < count; ++i) {
    const double time_s = i / kRate_hz;
    buffer.push(sample(time_s, pose_at(time_s)));
  }
  return buffer;
}

TEST(HandPrediction, FollowsAConstantAcceleration) {
  const PoseBuffer buffer = samples_of(accelerated, 12);
  const double at_s = 11 / kRate_hz + 0.05;
  const auto hand = predict_hand(buffer, ns(at_s), kNoise);
  ASSERT_TRUE(hand.has_value());
  EXPECT_LT(hand_movement(hand->room_from_hand, accelerated(at_s)).norm(), 1e-6);
  EXPECT_NEAR(hand->predicted_s, 0.05, 1e-8);
  constexpr double kStep_s = 1e-4;
  const Vector6d rate =
      hand_movement(accelerated(at_s - kStep_s), accelerated(at_s + kStep_s)) / (2 * kStep_s);
  EXPECT_LT((hand->angular_velocity - rate.head<3>()).norm(), 1e-5);
  EXPECT_LT((hand->velocity - rate.tail<3>()).norm(), 1e-4);
}

TEST(HandPrediction, NeverLeansOnWhatWasBeforeAHiddenSample) {
  PoseBuffer hidden = samples_of(accelerated, 12);
  hidden.push(hidden_sample(12 / kRate_hz));
  EXPECT_FALSE(predict_hand(hidden, ns(0.21), kNoise)) << "the newest is hidden";
  // Poses that would show, were they used.
  PoseBuffer reappeared;
  for (int i = 0; i < 6; ++i) reappeared.push(sample(i / kRate_hz, Pose::Identity()));
  reappeared.push(hidden_sample(6 / kRate_hz));
  for (int i = 7; i < 11; ++i) {
    reappeared.push(sample(i / kRate_hz, accelerated(i / kRate_hz)));
    EXPECT_FALSE(predict_hand(reappeared, ns(i / kRate_hz + 0.01), kNoise)) << "too few since";
  }
  reappeared.push(sample(11 / kRate_hz, accelerated(11 / kRate_hz)));
  const double at_s = 11 / kRate_hz + 0.01;
  const auto hand = predict_hand(reappeared, ns(at_s), kNoise);
  ASSERT_TRUE(hand.has_value());
  EXPECT_LT(hand_movement(hand->room_from_hand, accelerated(at_s)).norm(), 1e-6);
}

TEST(HandPrediction, NeverLeansOnWhatWasBeforeAGapOrAClocksJump) {
  for (const bool jump : {false, true}) {
    PoseBuffer buffer;
    for (int i = 0; i < 6; ++i) buffer.push(sample(i / kRate_hz, Pose::Identity()));
    const double after_s = (jump ? 6 : 12) / kRate_hz;
    for (int i = 0; i < 4; ++i) {
      HandSample later = sample(after_s + i / kRate_hz, accelerated(i / kRate_hz));
      if (jump) later.clock_epoch = 1;
      buffer.push(later);
    }
    EXPECT_FALSE(predict_hand(buffer, ns(after_s + 4 / kRate_hz), kNoise)) << jump;
  }
  EXPECT_FALSE(predict_hand(PoseBuffer(), 0, kNoise));
}

TEST(HandPrediction, CovarianceGrowsWithTheHorizon) {
  const PoseBuffer buffer = samples_of(accelerated, 12);
  double before = 0;
  for (int ahead_ms = 1; ahead_ms <= 60; ++ahead_ms) {
    const auto hand = predict_hand(buffer, ns(11 / kRate_hz) + ahead_ms * kMillisecond_ns, kNoise);
    ASSERT_TRUE(hand.has_value());
    const double now = hand->covariance.bottomRightCorner<3, 3>().trace();
    EXPECT_GT(now, before) << ahead_ms << " ms";
    before = now;
  }
}

TEST(HandPrediction, TakesASamplesOwnCovariance) {
  const Pose still = accelerated(0);
  PoseBuffer plain;
  PoseBuffer with_own;
  for (int i = 0; i < 12; ++i) {
    HandSample still_sample = sample(i / kRate_hz, still);
    plain.push(still_sample);
    still_sample.covariance = (4 * hand_sample_covariance(kNoise)).cast<float>();
    with_own.push(still_sample);
  }
  const std::int64_t at_ns = ns(11 / kRate_hz) + 20 * kMillisecond_ns;
  const auto one = predict_hand(plain, at_ns, kNoise);
  const auto other = predict_hand(with_own, at_ns, kNoise);
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(other->covariance(i, i) / one->covariance(i, i), 4, 1e-4) << i;
  }
}

}  // namespace
}  // namespace handeye
