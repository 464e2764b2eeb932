// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/unit/handeye/regimes.hpp"
#include "tests/unit/handeye/spoiled.hpp"
#include "tests/unit/handeye/synthetic.hpp"

/// A fifth of the poses wrong: the likelihood itself, given them all.
namespace handeye {
namespace {

using synthetic::RmsError;
using synthetic::Spoiling;

constexpr std::uint32_t kSeeds = 100;
constexpr int kPoses = 60;
constexpr double kMostWorse = 1.3;

std::vector<HandEyeObservation> observed(const std::vector<PosePair>& poses) {
  std::vector<HandEyeObservation> observations;
  for (const PosePair& pair : poses) observations.push_back({.poses = pair});
  return observations;
}

class LikelihoodOutliers : public testing::TestWithParam<synthetic::NamedSpoiling> {};

void expect_unmoved(Spoiling spoiling, ScaleMode scale) {
  const synthetic::Truth truth = synthetic::scope(scale == ScaleMode::kKnown ? 1.0 : 0.02);
  const double units = truth.solution.scale_units_per_mm;
  const MaximumLikelihoodOptions options{.account_for_correlation = false,
                                         .estimate_scale = scale == ScaleMode::kUnknown};
  RmsError clean, wrong;
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    const auto poses =
        synthetic::every(5, synthetic::record(truth, synthetic::free_hand, 5 * kPoses,
                                              synthetic::tracker_and_camera(), seed)
                                .poses());
    std::mt19937 generator(seed);
    const auto which = synthetic::some_of(poses.size(), poses.size() / 5, false, generator);
    const auto without = maximum_likelihood(observed(synthetic::without(poses, which)), options);
    const auto with = maximum_likelihood(
        observed(synthetic::spoiled(poses, which, spoiling, units, generator)), options);
    ASSERT_TRUE(without && with) << seed;
    EXPECT_EQ(with->rejected, which) << seed;
    const Pose& wanted = truth.solution.hand_from_eye;
    clean.add(synthetic::error_of(without->solution.hand_from_eye, wanted));
    wrong.add(synthetic::error_of(with->solution.hand_from_eye, wanted));
  }
  fmt::print("{:.4f} deg, {:.4f} mm; without the wrong poses {:.4f} deg, {:.4f} mm\n",
             wrong.rotation_deg(), wrong.translation_mm(), clean.rotation_deg(),
             clean.translation_mm());
  EXPECT_LE(wrong.rotation_deg(), kMostWorse * clean.rotation_deg());
  EXPECT_LE(wrong.translation_mm(), kMostWorse * clean.translation_mm());
}

TEST_P(LikelihoodOutliers, DoNotMoveItWithKnownScale) {
  expect_unmoved(GetParam().spoiling, ScaleMode::kKnown);
}

TEST_P(LikelihoodOutliers, DoNotMoveItWithUnknownScale) {
  expect_unmoved(GetParam().spoiling, ScaleMode::kUnknown);
}

std::string name_of(const testing::TestParamInfo<synthetic::NamedSpoiling>& info) {
  std::string name(info.param.name);
  std::erase(name, ' ');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Spoilings, LikelihoodOutliers, testing::ValuesIn(synthetic::kSpoilings),
                         name_of);

}  // namespace
}  // namespace handeye
