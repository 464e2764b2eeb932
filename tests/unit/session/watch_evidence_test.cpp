// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include "daemon/session/calibration_watch_descent.hpp"
#include "daemon/session/calibration_watch_evidence.hpp"
#include "daemon/session/calibration_watch_residuals.hpp"

namespace handeye::test {
namespace {

constexpr double kImageNoise = 0.4 / 560.0;

double drawn(std::mt19937& random, double sigma) {
  return std::normal_distribution<double>(0.0, sigma)(random);
}

/// A hand that rests, and what its tracker says: white errors, or those of the last frames again.
struct Hand {
  std::vector<WatchFrame> frames;
  WatchUnknowns at;

  explicit Hand(double lasting_share, std::size_t count = 48) {
    std::mt19937 random(7);
    Vector6d before = Vector6d::Zero();
    for (std::size_t k = 0; k < count; ++k) {
      Vector6d error;
      for (double& one : error) one = drawn(random, 1.0);
      before = lasting_share * before + std::sqrt(1.0 - lasting_share * lasting_share) * error;
      WatchFrame frame;
      frame.hand_covariance = Matrix6d::Identity() * 1e-4;
      frame.room_from_hand.linear() = exp_so3(0.01 * before.head<3>());
      frame.room_from_hand.translation() = 0.01 * before.tail<3>();
      frames.push_back(frame);
      at.room_from_eye.push_back(Pose::Identity());
    }
  }
};

TEST(WatchHandLasting, IsOneForWhiteErrors) {
  const Hand hand(0.0);
  EXPECT_LT(watch_hand_lasting(hand.frames, hand.at), 1.3);
}

TEST(WatchHandLasting, TellsErrorsThatLast) {
  const Hand hand(0.8);
  // (1 + 0.8) / (1 - 0.8) = 9 were there no end to the frames.
  const double lasting = watch_hand_lasting(hand.frames, hand.at);
  EXPECT_GT(lasting, 3.0);
  EXPECT_LT(lasting, 15.0);
}

/// Eyes that go sideways by 0.5 mm a frame before points at 70 mm, and one feature that slides.
struct Sideways {
  std::vector<WatchFrame> frames;
  WatchUnknowns at;
  std::size_t points{30};

  Sideways() {
    std::mt19937 random(11);
    for (int k = 0; k < 20; ++k) {
      WatchFrame frame;
      frame.room_from_hand.translation().x() = 0.5 * k;
      frame.hand_covariance.diagonal() << Vector6d::Constant(1e-6);
      frame.hand_covariance.diagonal().tail<3>().setConstant(0.02);
      for (std::size_t i = 0; i < points; ++i) {
        const auto place = static_cast<double>(i);
        const Eigen::Vector3d point(3.0 * place - 45.0, 20.0 * std::sin(place), 70.0);
        const Eigen::Vector3d seen = point - frame.room_from_hand.translation();
        const double x = drawn(random, kImageNoise);
        frame.rays.push_back({static_cast<std::int64_t>(i),
                              seen.hnormalized() + Eigen::Vector2d(x, drawn(random, kImageNoise))});
      }
      // As if it were 4 mm before the lens.
      frame.rays.push_back(
          {static_cast<std::int64_t>(points), Eigen::Vector2d(0.3 - 0.125 * k, 0.1)});
      frames.push_back(frame);
      at.room_from_eye.push_back(frame.room_from_hand);
    }
    at.tracks = watch_tracks(frames, 3);
    place_points(at.room_from_eye, at.tracks);
  }
};

TEST(WatchWildTracks, AFeatureBeforeTheLensIsLeftOut) {
  Sideways scene;
  settle_points({.image = kImageNoise, .robust_image = 0}, scene.at);
  const WatchDepth depth = scene_depth(scene.at);
  EXPECT_NEAR(depth.usual, 1.0 / 70.0, 0.002);
  settle_points({.image = kImageNoise, .robust_image = 0, .depth = depth}, scene.at);
  ASSERT_EQ(scene.at.tracks.size(), scene.points + 1);
  leave_out_wild_tracks(kImageNoise, depth, {.most_times = 1e9}, scene.at);
  EXPECT_EQ(scene.at.tracks.size(), scene.points);
}

TEST(WatchDescent, ComesToTheMinimumWithTrustFrozen) {
  Sideways scene;
  WatchWeights weights{.image = kImageNoise, .robust_image = 4.0 * kImageNoise};
  settle_points(weights, scene.at);
  weights.depth = scene_depth(scene.at);
  watch_descend(scene.frames, weights, 6, scene.at);
  leave_out_wild_tracks(kImageNoise, weights.depth, {}, scene.at);
  freeze_trust(weights, scene.at);
  weights.robust_image = 0;
  EXPECT_TRUE(watch_descend(scene.frames, weights, 40, scene.at).converged);
  const double cost = watch_cost(scene.frames, scene.at, weights);
  const WatchDescent again = watch_descend(scene.frames, weights, 40, scene.at);
  EXPECT_LE(again.iterations, 2);
  EXPECT_NEAR(watch_cost(scene.frames, scene.at, weights), cost, 0.1);
}

/// A fit that is off by 1 deg, 8 sigma.
WatchFit turned_fit(double lasting) {
  WatchFit fit;
  fit.hand_from_eye.linear() = exp_so3({kPi / 180.0, 0.0, 0.0});
  fit.covariance = Matrix6d::Identity() * std::pow(kPi / 180.0 / 8.0, 2);
  fit.hand_excess = fit.image_excess = 1.0;
  fit.converged = true;
  fit.lasting = lasting;
  fit.gain = 64.0 / lasting;
  return fit;
}

TEST(WatchEvidence, ATurnContradicts) {
  const WatchEvidence evidence = weigh(turned_fit(1.0), Pose::Identity(), Matrix6d::Zero());
  EXPECT_EQ(evidence.kind, WatchEvidence::Kind::kContradicts);
}

TEST(WatchEvidence, WhatLastingErrorsMayHaveMadeSaysNothing) {
  const WatchEvidence evidence = weigh(turned_fit(3.0), Pose::Identity(), Matrix6d::Zero());
  EXPECT_EQ(evidence.kind, WatchEvidence::Kind::kNone);
}

}  // namespace
}  // namespace handeye::test
