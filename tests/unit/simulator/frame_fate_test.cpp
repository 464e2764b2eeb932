// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/frame_fate.hpp"

#include <gtest/gtest.h>

#include "tests/unit/simulator/disturbed_world.hpp"

namespace handeye::simulator {
namespace {

constexpr double kRateHz = 25;

TEST(FrameFate, LosesTheShareOfFramesThatWasAskedFor) {
  constexpr std::uint32_t kFrames = 200'000;
  for (const double share : {0.0, 0.08, 0.3}) {
    const FrameFates fates({.missing_share = share}, 12, kRateHz);
    int missing = 0;
    int pairs = 0;
    for (std::uint32_t number = 1; number < kFrames; ++number) {
      if (!fates.of(number).missing) continue;
      ++missing;
      if (fates.of(number - 1).missing) ++pairs;
    }
    EXPECT_NEAR(missing / static_cast<double>(kFrames), share, 0.01);
    // Gaps of two frames are part of it.
    EXPECT_GE(pairs, 0.15 * missing);
    EXPECT_LE(pairs, 0.4 * missing);
  }
}

TEST(FrameFate, ShortRecordingsLoseTheirShareToo) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const FrameFates fates({.missing_share = 0.08}, seed, kRateHz);
    int missing = 0;
    for (std::uint32_t number = 0; number < 200; ++number) {
      missing += static_cast<int>(fates.of(number).missing);
    }
    EXPECT_NEAR(missing, 16, 5) << "seed " << seed;
  }
}

TEST(FrameFate, AnotherSeedLosesOtherFrames) {
  const FrameFates one({.missing_share = 0.08}, 1, kRateHz);
  const FrameFates other({.missing_share = 0.08}, 2, kRateHz);
  int different = 0;
  for (std::uint32_t number = 0; number < 1000; ++number) {
    different += static_cast<int>(one.of(number).missing != other.of(number).missing);
  }
  EXPECT_GT(different, 50);
}

TEST(FrameFate, StretchesAreAsLongAsAskedForEveryTenSeconds) {
  const FrameFates fates({.frozen_s = 1.0, .dark_s = 0.8}, 1, kRateHz);
  int frozen = 0;
  int dark = 0;
  for (std::uint32_t number = 0; number < 500; ++number) {
    const FrameFate fate = fates.of(number);
    EXPECT_LE(fate.shown, number);
    if (fate.frozen(number)) {
      ++frozen;
      EXPECT_EQ(fates.of(number - 1).shown, fate.shown);
    }
    dark += static_cast<int>(fate.dark);
  }
  // The first of a frozen stretch is a picture of its own.
  EXPECT_EQ(frozen, 2 * 24);
  EXPECT_EQ(dark, 2 * 20);
}

TEST(FrameFate, FrozenPicturesAreTheSameToTheLastBit) {
  SimulatorOptions options = quiet_options(2);
  options.image_noise_grey = 2;
  options.disturbances.frozen_s = 0.4;
  const World world(options, 0);
  EndoscopeView view(world);
  std::uint32_t number = 1;
  while (!view.fate(number).frozen(number)) ++number;
  const cv::Mat1b before = drawn(view, number - 2);
  const cv::Mat1b last_seen = drawn(view, number - 1);
  EXPECT_GT(cv::norm(before, last_seen, cv::NORM_INF), 0.0);
  for (; view.fate(number).frozen(number); ++number) {
    EXPECT_EQ(cv::norm(drawn(view, number), last_seen, cv::NORM_INF), 0.0);
  }
  EXPECT_GT(cv::norm(drawn(view, number), last_seen, cv::NORM_INF), 0.0);
}

TEST(FrameFate, DarkPicturesShowNothingButNoise) {
  SimulatorOptions options = quiet_options(2);
  options.image_noise_grey = 1.5;
  options.disturbances.dark_s = 0.4;
  const World world(options, 0);
  EndoscopeView view(world);
  std::uint32_t number = 0;
  while (!view.fate(number).dark) ++number;
  EXPECT_GT(cv::mean(drawn(view, number - 1))[0], 60.0);
  EXPECT_LT(cv::mean(drawn(view, number))[0], 2.0);
  EXPECT_GT(cv::norm(drawn(view, number), drawn(view, number + 1), cv::NORM_INF), 0.0);
}

}  // namespace
}  // namespace handeye::simulator
