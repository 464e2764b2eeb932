// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/sync/hand_smoothing.hpp"

#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace handeye {
namespace {

constexpr std::int64_t kStep_ns = 16'666'667;  // 60 Hz
constexpr double kRotation_rad = 1e-3;
constexpr double kTranslation_mm = 0.15;

/// A hand that swings 20 deg and 30 mm, by half a turn of its phase a second.
Pose swinging(std::int64_t time_ns) {
  const double phase = kPi * 1e-9 * static_cast<double>(time_ns);
  const double turn = rad_from_deg(20) * std::sin(phase);
  return make_pose(
      Eigen::Quaterniond(exp_so3(turn * Eigen::Vector3d(0.6, -0.8, 0).normalized())),
      {400 + 30 * std::cos(phase), 30 * std::sin(0.7 * phase), 900 + 10 * std::sin(phase)});
}

class NoisyHand {
 public:
  explicit NoisyHand(std::uint32_t seed) : generator_(seed) {}

  HandSample sample(std::int64_t time_ns, double noise) {
    HandSample result{
        .timestamp_ns = time_ns, .tracked = true, .room_from_hand = swinging(time_ns)};
    result.room_from_hand.linear() =
        exp_so3(noise * kRotation_rad * normal3()) * result.room_from_hand.linear();
    result.room_from_hand.translation() += noise * kTranslation_mm * normal3();
    return result;
  }
  PoseBuffer samples(int count, double noise) {
    PoseBuffer buffer;
    for (int i = 0; i < count; ++i) buffer.push(sample(i * kStep_ns, noise));
    return buffer;
  }

 private:
  Eigen::Vector3d normal3() {
    return {normal_(generator_), normal_(generator_), normal_(generator_)};
  }
  std::mt19937 generator_;
  std::normal_distribution<double> normal_;
};

double off_mm(const Pose& found, std::int64_t time_ns) {
  return (found.translation() - swinging(time_ns).translation()).norm();
}

double off_rad(const Pose& found, std::int64_t time_ns) {
  return log_so3(found.linear() * swinging(time_ns).linear().transpose()).norm();
}

double sum_of_squares(const std::vector<double>& shares) {
  return std::inner_product(shares.begin(), shares.end(), shares.begin(), 0.0);
}

// The straight line between two samples is off by 0.007 deg and 0.01 mm at the middle.
TEST(HandSmoothing, FollowsAHandWithoutNoise) {
  const PoseBuffer buffer = NoisyHand(1).samples(240, 0);
  const HandSmoothing smoothing(buffer);
  double line_mm = 0;
  for (std::int64_t time_ns = 100'000'000; time_ns < 3'800'000'000; time_ns += 7'300'000) {
    const auto found = smoothing.at(time_ns);
    ASSERT_TRUE(found);
    EXPECT_LT(off_rad(found->room_from_hand, time_ns), rad_from_deg(2e-4));
    EXPECT_LT(off_mm(found->room_from_hand, time_ns), 3e-4);
    line_mm = std::max(line_mm, off_mm(buffer.lookup(time_ns).room_from_hand, time_ns));
  }
  EXPECT_GT(line_mm, 5e-3);
}

TEST(HandSmoothing, KnowsTheVelocities) {
  const PoseBuffer buffer = NoisyHand(1).samples(120, 0);
  const HandSmoothing smoothing(buffer);
  constexpr std::int64_t kNear_ns = 1'000'000;
  for (std::int64_t time_ns = 200'000'000; time_ns < 1'700'000'000; time_ns += 31'000'000) {
    const auto found = smoothing.at(time_ns);
    ASSERT_TRUE(found);
    const Pose before = swinging(time_ns - kNear_ns);
    const Pose after = swinging(time_ns + kNear_ns);
    const Eigen::Vector3d angular = log_so3(before.linear().transpose() * after.linear()) / 2e-3;
    EXPECT_LT((found->angular_velocity - angular).norm(), 0.003 * angular.norm() + 1e-4);
    const Eigen::Vector3d velocity = (after.translation() - before.translation()) / 2e-3;
    EXPECT_LT((found->velocity - velocity).norm(), 0.003 * velocity.norm() + 0.01);
  }
}

// What is claimed by the shares is what the errors are; half of the straight line's.
TEST(HandSmoothing, LowersTheNoiseAsItsSharesSay) {
  double squares = 0;
  double claimed = 0;
  double of_line = 0;
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const PoseBuffer buffer = NoisyHand(seed).samples(600, 1);
    const HandSmoothing smoothing(buffer);
    for (std::int64_t time_ns = 100'000'000; time_ns < 9'800'000'000; time_ns += 40'000'000) {
      const auto found = smoothing.at(time_ns);
      ASSERT_TRUE(found);
      EXPECT_NEAR(std::accumulate(found->shares.begin(), found->shares.end(), 0.0), 1.0, 1e-9);
      squares += std::pow(off_mm(found->room_from_hand, time_ns) / kTranslation_mm, 2) / 3;
      squares += std::pow(off_rad(found->room_from_hand, time_ns) / kRotation_rad, 2) / 3;
      claimed += 2 * sum_of_squares(found->shares);
      const double a = buffer.lookup(time_ns).fraction;
      of_line += 2 * ((1 - a) * (1 - a) + a * a);
    }
  }
  // 4860 instants, of which neighbours share samples: 3.3 standard deviations are some 4 %.
  EXPECT_NEAR(squares / claimed, 1.0, 0.04);
  EXPECT_LT(claimed, 0.55 * of_line);
}

TEST(HandSmoothing, NamesTheSamplesThatHaveShares) {
  const PoseBuffer buffer = NoisyHand(2).samples(60, 1);
  const HandSmoothing smoothing(buffer);
  const std::int64_t time_ns = 30 * kStep_ns + 5'000'000;
  const auto found = smoothing.at(time_ns);
  ASSERT_TRUE(found);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < found->shares.size(); ++i) {
    sum += found->shares[i] *
           buffer.at(buffer.index_of(found->sample) + i).room_from_hand.translation();
  }
  EXPECT_LT((sum - found->room_from_hand.translation()).norm(), 1e-9);
}

TEST(HandSmoothing, LeavesOutASampleThatFlies) {
  NoisyHand hand(3);
  PoseBuffer buffer;
  for (int i = 0; i < 120; ++i) {
    HandSample sample = hand.sample(i * kStep_ns, 1);
    if (i == 60) sample.room_from_hand.translation() += Eigen::Vector3d(3, 0, 0);
    if (i == 80)
      sample.room_from_hand.linear() = exp_so3({0, 0, 0.03}) * sample.room_from_hand.linear();
    buffer.push(sample);
  }
  const HandSmoothing smoothing(buffer);
  for (std::int64_t time_ns = 900'000'000; time_ns < 1'500'000'000; time_ns += 3'000'000) {
    const auto found = smoothing.at(time_ns);
    ASSERT_TRUE(found);
    EXPECT_LT(off_mm(found->room_from_hand, time_ns), 5 * kTranslation_mm) << time_ns;
    EXPECT_LT(off_rad(found->room_from_hand, time_ns), 5 * kRotation_rad) << time_ns;
  }
}

// A knock of the scope is no noise: nothing is smoothed across it.
TEST(HandSmoothing, DoesNotSmoothOverAJump) {
  NoisyHand hand(4);
  PoseBuffer buffer;
  for (int i = 0; i < 120; ++i) {
    HandSample sample = hand.sample(i * kStep_ns, 1);
    if (i >= 60) sample.room_from_hand.translation() += Eigen::Vector3d(0, 8, 0);
    buffer.push(sample);
  }
  const HandSmoothing smoothing(buffer);
  for (const int i : {58, 60}) {
    const std::int64_t time_ns = i * kStep_ns + 4'000'000;
    const auto found = smoothing.at(time_ns);
    ASSERT_TRUE(found);
    const Eigen::Vector3d jumped(0, i >= 60 ? 8 : 0, 0);
    EXPECT_LT(
        (found->room_from_hand.translation() - jumped - swinging(time_ns).translation()).norm(),
        5 * kTranslation_mm);
  }
}

TEST(HandSmoothing, IsTheStraightLineWhereSamplesAreFew) {
  NoisyHand hand(5);
  PoseBuffer buffer;
  for (int i = 0; i < 60; ++i) buffer.push(hand.sample(i * 2 * kStep_ns, 1));  // 30 Hz
  const HandSmoothing smoothing(buffer, {.reach_ns = 50'000'000});
  const std::int64_t time_ns = 500'000'000;
  const auto found = smoothing.at(time_ns);
  const HandLookup line = buffer.lookup(time_ns);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->room_from_hand.isApprox(line.room_from_hand, 1e-12));
  EXPECT_EQ(found->sample, line.sample);
  ASSERT_EQ(found->shares.size(), 2U);
  EXPECT_DOUBLE_EQ(found->shares[1], line.fraction);
}

TEST(HandSmoothing, HasNothingWhereTheHandWasHidden) {
  NoisyHand hand(6);
  PoseBuffer buffer;
  for (int i = 0; i < 90; ++i) {
    HandSample sample = hand.sample(i * kStep_ns, 1);
    sample.tracked = i < 40 || i >= 50;
    buffer.push(sample);
  }
  const HandSmoothing smoothing(buffer);
  EXPECT_FALSE(smoothing.at(45 * kStep_ns));
  EXPECT_FALSE(smoothing.at(-1));
  // Beside it no worse than the line.
  for (const int i : {38, 50}) {
    const auto found = smoothing.at(i * kStep_ns + kStep_ns / 2);
    ASSERT_TRUE(found);
    EXPECT_LE(sum_of_squares(found->shares), 0.5 + 1e-6);
  }
}

TEST(HandSmoothing, AveragesWhatTheSamplesSayOfThemselves) {
  NoisyHand hand(7);
  PoseBuffer buffer;
  for (int i = 0; i < 60; ++i) {
    HandSample sample = hand.sample(i * kStep_ns, 1);
    sample.covariance = Eigen::Matrix<float, 6, 6>::Identity() * (i < 30 ? 1.0F : 3.0F);
    buffer.push(sample);
  }
  const HandSmoothing smoothing(buffer);
  EXPECT_NEAR((*smoothing.at(10 * kStep_ns + 1)->sample_covariance)(0, 0), 1.0, 1e-6);
  EXPECT_NEAR((*smoothing.at(50 * kStep_ns + 1)->sample_covariance)(3, 3), 3.0, 1e-6);
  const double at_change = (*smoothing.at(30 * kStep_ns - 1)->sample_covariance)(0, 0);
  EXPECT_GT(at_change, 1.2);
  EXPECT_LT(at_change, 2.8);
}

}  // namespace
}  // namespace handeye
