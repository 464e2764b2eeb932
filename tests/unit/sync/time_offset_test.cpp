// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/sync/time_offset.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace handeye {
namespace {

/// Free-hand rotation: a few incommensurable swings about each axis, +-20 deg.
Eigen::Matrix3d hand_rotation(double time_s) {
  const auto swing = [&](double hz, double phase) {
    return std::sin(2 * kPi * hz * time_s + phase);
  };
  return exp_so3(rad_from_deg(20) *
                 Eigen::Vector3d(0.6 * swing(0.31, 0.2) + 0.4 * swing(0.73, 1.0),
                                 0.6 * swing(0.23, 2.0) + 0.4 * swing(0.89, 0.4),
                                 0.6 * swing(0.41, 4.0) + 0.4 * swing(0.61, 2.2)));
}

struct Streams {
  PoseBuffer hand;
  std::vector<EyeSample> eye;
};

/// Camera stamps are the true times; tracker stamps are true time - offset, so that adding the
/// offset to a tracker stamp gives the camera's stamp of the same instant.
template <typename Rotation>
Streams simulate(const Rotation& rotation, double time_offset_s, double hand_noise_rad,
                 double eye_noise_rad, std::uint32_t seed, double length_s = 16) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  const auto noise = [&](double sigma) {
    return exp_so3(sigma *
                   Eigen::Vector3d(normal(generator), normal(generator), normal(generator)));
  };
  const Eigen::Matrix3d eye_from_hand = exp_so3({1.0, -0.4, 2.0});
  Streams streams;
  for (int i = 0; i < static_cast<int>(length_s * 60); ++i) {
    const double time_s = i / 60.0;
    HandSample sample{std::llround((time_s - time_offset_s) * 1e9), true, Pose::Identity()};
    sample.room_from_hand.linear() = rotation(time_s) * noise(hand_noise_rad);
    streams.hand.push(sample);
  }
  for (int i = 25; i < static_cast<int>(length_s * 25) - 25; ++i) {
    const double time_s = i / 25.0 + 0.0031;
    EyeSample sample{std::llround(time_s * 1e9), Pose::Identity()};
    sample.eye_from_scene.linear() =
        noise(eye_noise_rad) * eye_from_hand * rotation(time_s).transpose();
    streams.eye.push_back(sample);
  }
  return streams;
}

TEST(TimeOffset, IsWhatMustBeAddedToTrackerStamps) {
  for (const double offset_s : {-0.3, -0.0217, 0.0, 0.0033, 0.150}) {
    const Streams streams = simulate(hand_rotation, offset_s, 0, 0, 1);
    const auto found = correlate_angular_speed(streams.hand, streams.eye);
    ASSERT_TRUE(found) << offset_s;
    EXPECT_NEAR(found->time_offset_s, offset_s, 0.3e-3);
    EXPECT_GT(found->peak, 0.999);
    EXPECT_GT(found->confidence, 0.9) << offset_s;
  }
}

TEST(TimeOffset, IsUnbiasedAndHonestUnderNoise) {
  double sum = 0, squares = 0, normalised = 0;
  constexpr int kSeeds = 40;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Streams streams = simulate(hand_rotation, 0.042, rad_from_deg(0.06), rad_from_deg(0.03),
                                     static_cast<std::uint32_t>(seed));
    const auto found = correlate_angular_speed(streams.hand, streams.eye);
    ASSERT_TRUE(found);
    const double error = found->time_offset_s - 0.042;
    sum += error;
    squares += error * error;
    normalised += error * error / (found->sigma_s * found->sigma_s);
  }
  EXPECT_LT(std::abs(sum / kSeeds), 0.2e-3);
  EXPECT_LT(std::sqrt(squares / kSeeds), 0.5e-3);
  EXPECT_LT(normalised / kSeeds, 2.0);
  EXPECT_GT(normalised / kSeeds, 0.05);
}

/// A turn that only quickens slowly correlates well with its own shifts, over half of them as well
/// as over all, and its peak is broad.
TEST(TimeOffset, IsFoundWhereTheSpeedHasATrend) {
  const auto quickening = [](double t) {
    const double angle = 0.25 * t + 0.02 * t * t + 0.05 * std::sin(1.5 * t);
    return exp_so3({0.3 * std::sin(angle), 0.9 * std::sin(0.7 * angle), angle});
  };
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    const Streams streams =
        simulate(quickening, 0.032, rad_from_deg(0.06), rad_from_deg(0.03), seed, 12);
    const auto found = correlate_angular_speed(streams.hand, streams.eye);
    ASSERT_TRUE(found) << seed;
    EXPECT_NEAR(found->time_offset_s, 0.032, 0.010) << seed;
  }
}

TEST(TimeOffset, NeedsRotation) {
  const auto still = [](double) { return Eigen::Matrix3d(Eigen::Matrix3d::Identity()); };
  const Streams streams = simulate(still, 0.01, rad_from_deg(0.06), rad_from_deg(0.03), 2);
  EXPECT_FALSE(correlate_angular_speed(streams.hand, streams.eye));
}

TEST(TimeOffset, RefusesUnrelatedMotion) {
  Streams streams = simulate(hand_rotation, 0, 0, 0, 3);
  streams.eye = simulate([](double t) { return hand_rotation(1.7 * t + 40); }, 0, 0, 0, 3).eye;
  EXPECT_FALSE(correlate_angular_speed(streams.hand, streams.eye));
}

TEST(TimeOffset, RefusesPeriodicMotion) {
  const auto periodic = [](double time_s) {
    return exp_so3({0, 0, 0.3 * std::sin(2 * kPi * 1.5 * time_s)});
  };
  const Streams streams = simulate(periodic, 0.01, 0, 0, 4);
  EXPECT_FALSE(correlate_angular_speed(streams.hand, streams.eye));
}

TEST(TimeOffset, ReachesToTheEndsOfTheSearch) {
  for (const double offset_s : {-0.48, -0.45, 0.45, 0.48}) {
    const Streams streams =
        simulate(hand_rotation, offset_s, rad_from_deg(0.06), rad_from_deg(0.03), 11);
    const auto found = correlate_angular_speed(streams.hand, streams.eye);
    ASSERT_TRUE(found) << offset_s;
    EXPECT_NEAR(found->time_offset_s, offset_s, 2e-3);
    EXPECT_GT(found->confidence, 0.9);
  }
}

/// The nearer to one rhythm, the less sure which of its beats it is.
TEST(TimeOffset, ConfidenceFallsWithTheRhythm) {
  double last = 1;
  for (const double irregular : {4.0, 2.0, 1.2, 0.8, 0.3}) {
    const auto rhythm = [&](double t) {
      const double beat = std::sin(2 * kPi * 1.5 * t + irregular * std::sin(2 * kPi * 0.17 * t));
      return exp_so3({0, 0.1 * irregular * std::sin(2 * kPi * 0.31 * t),
                      (0.3 + 0.15 * irregular * std::sin(2 * kPi * 0.11 * t)) * beat});
    };
    const Streams streams = simulate(rhythm, 0.01, rad_from_deg(0.06), rad_from_deg(0.03), 4);
    const auto found = correlate_angular_speed(streams.hand, streams.eye);
    const double confidence = found ? found->confidence : 0;
    EXPECT_LE(confidence, last) << irregular;
    last = confidence;
  }
  EXPECT_LT(last, 0.5);
}

/// Noise takes the confidence away before it makes the answer wrong.
TEST(TimeOffset, WhatIsConfidentIsRightWhateverTheNoiseAndTheLength) {
  int confident = 0, all = 0;
  for (const double length_s : {4.0, 6.0, 10.0, 16.0}) {
    for (const double noise_deg : {0.03, 0.3, 1.0, 2.0}) {
      for (std::uint32_t seed = 0; seed < 4; ++seed) {
        const auto rotation = [&](double t) { return hand_rotation(t + 7.0 * seed); };
        const Streams streams =
            simulate(rotation, 0.12, rad_from_deg(0.06), rad_from_deg(noise_deg), seed, length_s);
        const auto found = correlate_angular_speed(streams.hand, streams.eye);
        ++all;
        if (!found || found->confidence < 0.5) continue;
        ++confident;
        EXPECT_NEAR(found->time_offset_s, 0.12, 0.04)
            << length_s << " s, " << noise_deg << " deg, seed " << seed;
      }
    }
  }
  RecordProperty("confident", confident);
  EXPECT_GT(confident, all / 3);
}

TEST(TimeOffset, RefusesAnOffsetBeyondTheSearch) {
  const Streams streams = simulate(hand_rotation, 0.55, 0, 0, 5);
  TimeOffsetOptions options;
  options.search_s = 0.2;
  const auto found = correlate_angular_speed(streams.hand, streams.eye, options);
  EXPECT_FALSE(found) << found->time_offset_s;
}

TEST(TimeOffset, SurvivesHiddenStretchesAndMissingFrames) {
  Streams streams = simulate(hand_rotation, -0.02, rad_from_deg(0.06), rad_from_deg(0.03), 6);
  PoseBuffer holed;
  for (std::size_t i = 0; i < streams.hand.size(); ++i) {
    HandSample sample = streams.hand.at(i);
    sample.tracked = i % 200 > 40;
    holed.push(sample);
  }
  std::vector<EyeSample> thinned;
  for (std::size_t i = 0; i < streams.eye.size(); ++i) {
    if (i % 7 != 3 && i % 60 > 10) thinned.push_back(streams.eye[i]);
  }
  const auto found = correlate_angular_speed(holed, thinned);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->time_offset_s, -0.02, 3e-3);
}

TEST(TimeOffset, NothingFromNothing) {
  EXPECT_FALSE(correlate_angular_speed(PoseBuffer(), {}));
}

}  // namespace
}  // namespace handeye
