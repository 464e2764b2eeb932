// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/sync/pose_buffer.hpp"

#include <algorithm>
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
  buffer.push(moving(4 * kStep_ns + 55'000'000));  // just bridged
  const std::int64_t after_ns = 4 * kStep_ns + 110'000'001;
  buffer.push(moving(after_ns));  // just not
  EXPECT_EQ(buffer.lookup(4 * kStep_ns + 50'000'000).status, LookupStatus::kOk);
  EXPECT_EQ(buffer.lookup(4 * kStep_ns + 90'000'000).status, LookupStatus::kGap);
  EXPECT_EQ(buffer.lookup(after_ns).status, LookupStatus::kOk);
}

TEST(PoseBuffer, BridgesTheNeighboursOfASlowTrackerUpToTheLimit) {
  for (const std::int64_t period_ns : {45'000'000, 66'000'000, 99'000'000, 101'000'000}) {
    PoseBuffer buffer;
    for (int i = 0; i < 100; ++i) buffer.push(moving(i * period_ns));
    const LookupStatus between = buffer.lookup(90 * period_ns + period_ns / 2).status;
    EXPECT_EQ(between, period_ns <= 100'000'000 ? LookupStatus::kOk : LookupStatus::kGap);
    buffer.push(moving(101 * period_ns));  // one was lost
    const LookupStatus across = buffer.lookup(100 * period_ns).status;
    EXPECT_EQ(across, LookupStatus::kGap) << period_ns;
  }
}

TEST(PoseBuffer, TheGapRuleFollowsTheTrackersRateInSpiteOfLosses) {
  PoseBuffer buffer;
  std::int64_t time_ns = 0;
  for (int i = 0; i < 400; ++i)
    buffer.push(moving(time_ns += i % 4 == 3 ? 180'000'000 : 60'000'000));
  EXPECT_NEAR(static_cast<double>(buffer.bridged_gap_ns()), 90e6, 4e6);
  for (int i = 0; i < 400; ++i) buffer.push(moving(time_ns += kStep_ns));
  EXPECT_EQ(buffer.bridged_gap_ns(), 55'000'000);
}

/// What the rule of the gaps rests on: a swing of 20 deg at 0.5 Hz about the line between samples.
TEST(PoseBuffer, InterpolatesAcrossWhatItBridgesBetterThanATrackerMeasures) {
  const double noise_deg = 0.06 * std::sqrt(3.0);  // a tracker's, of the whole rotation
  const auto worst_deg = [](std::int64_t gap_ns) {
    const auto swing = [](std::int64_t time_ns) {
      return exp_so3(
          {rad_from_deg(20) * std::sin(kPi * 1e-9 * static_cast<double>(time_ns)), 0, 0});
    };
    double worst = 0;
    for (std::int64_t begin_ns = 0; begin_ns < 2'000'000'000; begin_ns += 20'000'000) {
      PoseBuffer buffer({.accurate_gap_ns = gap_ns});
      for (const std::int64_t time_ns : {begin_ns, begin_ns + gap_ns}) {
        HandSample sample{time_ns, true, Pose::Identity()};
        sample.room_from_hand.linear() = swing(time_ns);
        buffer.push(sample);
      }
      const HandLookup found = buffer.lookup(begin_ns + gap_ns / 2);
      EXPECT_EQ(found.status, LookupStatus::kOk);
      worst = std::max(
          worst, rotation_angle_rad(found.room_from_hand.linear(), swing(begin_ns + gap_ns / 2)));
    }
    return deg_from_rad(worst);
  };
  EXPECT_LT(worst_deg(PoseBufferOptions().accurate_gap_ns), noise_deg);
  EXPECT_NEAR(worst_deg(PoseBufferOptions().accurate_gap_ns), 0.0746, 0.002);
  EXPECT_GT(worst_deg(100'000'000), 2 * noise_deg) << "so 100 ms would be too long";
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

TEST(PoseBuffer, TakesLateSamplesToTheirPlace) {
  PoseBuffer buffer;
  for (const int i : {0, 1, 2, 5, 3, 4, 6, 9, 8, 7, 10}) buffer.push(moving(i * kStep_ns));
  ASSERT_EQ(buffer.size(), 11U);
  for (std::size_t i = 0; i < 11; ++i) {
    EXPECT_EQ(buffer.at(i).timestamp_ns, static_cast<std::int64_t>(i) * kStep_ns);
    const HandLookup found = buffer.lookup(static_cast<std::int64_t>(i) * kStep_ns);
    EXPECT_EQ(found.sample, static_cast<std::int64_t>(i));
    EXPECT_LT((found.velocity - kVelocity).norm(), 1e-9);
  }
  EXPECT_EQ(buffer.reordered(), 4U);
  EXPECT_EQ(buffer.out_of_order(), 0U);
}

TEST(PoseBuffer, InAFullRingALateSampleDrivesOutTheOldest) {
  PoseBuffer buffer({.capacity = 4});
  for (const int i : {0, 1, 2, 3, 5, 4}) buffer.push(moving(i * kStep_ns));
  ASSERT_EQ(buffer.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(buffer.at(i).timestamp_ns, static_cast<std::int64_t>(i + 2) * kStep_ns);
  }
  EXPECT_EQ(buffer.lookup(4 * kStep_ns).sample, 4);
}

TEST(PoseBuffer, DropsAndCountsWhatCameTwiceOrFarTooLate) {
  PoseBuffer buffer = filled(20);
  buffer.push(moving(19 * kStep_ns));
  buffer.push(moving(19 * kStep_ns + PoseBuffer::kSameInstant_ns - 1));
  buffer.push(moving(17 * kStep_ns - 50'000));
  buffer.push(moving(17 * kStep_ns + 50'000));
  EXPECT_EQ(buffer.duplicates(), 4U);
  buffer.push(moving(11 * kStep_ns - kStep_ns / 2));
  EXPECT_EQ(buffer.out_of_order(), 1U);
  EXPECT_EQ(buffer.size(), 20U);
  EXPECT_EQ(buffer.reordered(), 0U);
}

TEST(PoseBuffer, DoesNotKeepSamplesOfDoubtfulTime) {
  PoseBuffer buffer = filled(5);
  HandSample doubtful = moving(5 * kStep_ns);
  doubtful.doubtful_time = true;
  doubtful.tracked = false;
  buffer.push(doubtful);
  buffer.push(moving(6 * kStep_ns));
  EXPECT_EQ(buffer.size(), 6U);
  EXPECT_EQ(buffer.lookup(5 * kStep_ns).status, LookupStatus::kOk) << "its neighbours do";
}

TEST(PoseBuffer, DoesNotCrossAClocksJump) {
  const auto later = [](std::int64_t timestamp_ns) {
    HandSample sample = moving(timestamp_ns);
    sample.clock_epoch = 1;
    return sample;
  };
  PoseBuffer buffer = filled(5);
  buffer.push(later(5 * kStep_ns));
  buffer.push(later(6 * kStep_ns));
  EXPECT_EQ(buffer.lookup(4 * kStep_ns).status, LookupStatus::kOk);
  EXPECT_EQ(buffer.lookup(4 * kStep_ns + 1).status, LookupStatus::kGap);
  EXPECT_EQ(buffer.lookup(5 * kStep_ns - 1).status, LookupStatus::kGap);
  EXPECT_EQ(buffer.lookup(5 * kStep_ns).status, LookupStatus::kOk);
  EXPECT_EQ(buffer.lookup(6 * kStep_ns - 1).status, LookupStatus::kOk);
  EXPECT_LT((buffer.lookup(5 * kStep_ns).velocity - kVelocity).norm(), 1e-9);

  buffer.push(moving(5 * kStep_ns + kStep_ns / 2));  // late, and of the epoch before
  EXPECT_EQ(buffer.out_of_order(), 1U);
  HandSample third = moving(6 * kStep_ns - 1'000'000);
  third.clock_epoch = 2;
  buffer.push(third);  // the jump took it back before what is there
  EXPECT_EQ(buffer.out_of_order(), 2U);
  third.timestamp_ns = 6 * kStep_ns + 1'000'000;
  buffer.push(third);
  EXPECT_EQ(buffer.size(), 8U);
}

TEST(PoseBuffer, ASingleSampleHasNoVelocity) {
  const PoseBuffer buffer = filled(1);
  const HandLookup found = buffer.lookup(0);
  EXPECT_EQ(found.status, LookupStatus::kOk);
  EXPECT_EQ(found.velocity, Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace handeye
