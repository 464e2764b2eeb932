// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/sync/pose_buffer.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace handeye {
namespace {

constexpr std::int64_t kStep_ns = 16'000'000;

/// Turns at a constant rate about a fixed axis of the hand, runs straight on.
const Eigen::Vector3d kAngularVelocity(0.3, -0.5, 0.2);
const Eigen::Vector3d kVelocity(40, -20, 10);

HandSample moving(std::int64_t timestamp_ns) {
  const double time_s = static_cast<double>(timestamp_ns) * 1e-9;
  HandSample sample{timestamp_ns, true, Pose::Identity()};
  sample.room_from_hand.linear() = exp_so3({0.2, 0.1, 0.7}) * exp_so3(time_s * kAngularVelocity);
  sample.room_from_hand.translation() = Eigen::Vector3d(100, 200, 300) + time_s * kVelocity;
  return sample;
}

PoseBuffer filled(int samples, std::size_t capacity = 8192) {
  PoseBuffer buffer({capacity, 100'000'000});
  for (int i = 0; i < samples; ++i) buffer.push(moving(i * kStep_ns));
  return buffer;
}

TEST(PoseBuffer, SaysWhereTheTimeLies) {
  PoseBuffer buffer;
  EXPECT_EQ(buffer.lookup(0).status, LookupStatus::kEmpty);
  buffer = filled(10);
  EXPECT_EQ(buffer.lookup(-1).status, LookupStatus::kTooOld);
  EXPECT_EQ(buffer.lookup(0).status, LookupStatus::kOk);
  EXPECT_EQ(buffer.lookup(9 * kStep_ns).status, LookupStatus::kOk);
  EXPECT_EQ(buffer.lookup(9 * kStep_ns + 1).status, LookupStatus::kTooNew);
  buffer.clear();
  EXPECT_EQ(buffer.size(), 0U);
  EXPECT_EQ(buffer.lookup(0).status, LookupStatus::kEmpty);
}

TEST(PoseBuffer, FollowsConstantMotionExactly) {
  const PoseBuffer buffer = filled(40);
  for (std::int64_t time = 0; time <= 39 * kStep_ns; time += 1'234'567) {
    const HandLookup found = buffer.lookup(time);
    ASSERT_EQ(found.status, LookupStatus::kOk);
    EXPECT_TRUE(found.room_from_hand.isApprox(moving(time).room_from_hand, 1e-12));
    EXPECT_LT((found.angular_velocity - kAngularVelocity).norm(), 1e-10);
    EXPECT_LT((found.velocity - kVelocity).norm(), 1e-9);
    const double expected = static_cast<double>(time % kStep_ns) / static_cast<double>(kStep_ns);
    EXPECT_NEAR(found.fraction, expected, 1e-12);
  }
}

TEST(PoseBuffer, DoesNotCrossGaps) {
  PoseBuffer buffer = filled(5);
  buffer.push(moving(4 * kStep_ns + 100'000'000));  // just bridged
  buffer.push(moving(4 * kStep_ns + 200'000'001));  // just not
  EXPECT_EQ(buffer.lookup(4 * kStep_ns + 50'000'000).status, LookupStatus::kOk);
  EXPECT_EQ(buffer.lookup(4 * kStep_ns + 150'000'000).status, LookupStatus::kGap);
  EXPECT_EQ(buffer.lookup(4 * kStep_ns + 200'000'001).status, LookupStatus::kOk);
}

TEST(PoseBuffer, DoesNotUseHiddenSamples) {
  PoseBuffer buffer = filled(5);
  buffer.push({5 * kStep_ns, false, Pose::Identity()});
  buffer.push(moving(6 * kStep_ns));
  buffer.push(moving(7 * kStep_ns));
  EXPECT_EQ(buffer.lookup(4 * kStep_ns).status, LookupStatus::kOk);
  EXPECT_EQ(buffer.lookup(4 * kStep_ns + 1).status, LookupStatus::kHidden);
  EXPECT_EQ(buffer.lookup(5 * kStep_ns).status, LookupStatus::kHidden);
  EXPECT_EQ(buffer.lookup(6 * kStep_ns - 1).status, LookupStatus::kHidden);
  const HandLookup after = buffer.lookup(6 * kStep_ns);
  EXPECT_EQ(after.status, LookupStatus::kOk);
  EXPECT_LT((after.velocity - kVelocity).norm(), 1e-9);  // not taken across the hidden sample
}

TEST(PoseBuffer, KeepsTheNewestWhenFull) {
  const PoseBuffer buffer = filled(100, 16);
  EXPECT_EQ(buffer.size(), 16U);
  EXPECT_EQ(buffer.at(0).timestamp_ns, 84 * kStep_ns);
  EXPECT_EQ(buffer.at(15).timestamp_ns, 99 * kStep_ns);
  EXPECT_EQ(buffer.lookup(83 * kStep_ns).status, LookupStatus::kTooOld);
  const std::int64_t time = 90 * kStep_ns + 5;
  EXPECT_TRUE(buffer.lookup(time).room_from_hand.isApprox(moving(time).room_from_hand, 1e-12));
}

TEST(PoseBuffer, DropsAndCountsWhatIsNotNewer) {
  PoseBuffer buffer = filled(3);
  buffer.push(moving(2 * kStep_ns));
  buffer.push(moving(kStep_ns));
  EXPECT_EQ(buffer.size(), 3U);
  EXPECT_EQ(buffer.out_of_order(), 2U);
}

TEST(PoseBuffer, ASingleSampleHasNoVelocity) {
  const PoseBuffer buffer = filled(1);
  const HandLookup found = buffer.lookup(0);
  EXPECT_EQ(found.status, LookupStatus::kOk);
  EXPECT_EQ(found.velocity, Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace handeye
