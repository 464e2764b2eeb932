// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/handeye/methods/methods.hpp"
#include "daemon/handeye/selection.hpp"
#include "tests/unit/handeye/spoiled.hpp"
#include "tests/unit/handeye/synthetic.hpp"

namespace handeye {
namespace {

constexpr std::uint32_t kSeeds = 50;
constexpr double kMostWorse = 1.3;

/// Squared errors of every method, summed over seeds.
struct Errors {
  std::vector<double> rotation;
  std::vector<double> translation;

  explicit Errors(std::size_t methods) : rotation(methods), translation(methods) {}

  void add(std::span<const Method> table, const std::vector<PosePair>& poses, ScaleMode mode,
           const Pose& truth) {
    const Selection selection = select_movements(poses, {.scale = mode});
    const std::vector<PosePair> right = synthetic::without(poses, selection.wrong_poses);
    const HandEyeProblem problem{
        .poses = right, .movements = selection.movements, .noise = synthetic::tracker_and_camera()};
    for (std::size_t k = 0; k < table.size(); ++k) {
      const auto found = table[k].solve(problem);
      ASSERT_TRUE(found) << table[k].name;
      const Vector6d error = synthetic::error_of(found->hand_from_eye, truth);
      rotation[k] += error.head<3>().squaredNorm();
      translation[k] += error.tail<3>().squaredNorm();
    }
  }
};

struct Regime {
  const char* name;
  bool free_hand;
  int poses;
  bool one_stretch;
};

/// A fifth of the poses wrong, against the same poses without these. As everywhere, methods are
/// given what the selection left: the likelihood the poses, the others the movements.
void expect_unmoved(ScaleMode mode, const Regime& regime) {
  const double scale = mode == ScaleMode::kKnown ? 1.0 : 0.02;
  const std::span<const Method> table = methods(mode);
  Errors clean(table.size());
  std::vector<Errors> wrong(synthetic::kSpoilings.size(), clean);
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    std::mt19937 generator(seed);
    synthetic::Truth truth = synthetic::scope(scale);
    std::vector<PosePair> poses;
    if (regime.free_hand) {
      poses = synthetic::every(8, synthetic::record(truth, synthetic::free_hand, 8 * regime.poses,
                                                    synthetic::tracker_and_camera(), seed)
                                      .poses());
    } else {
      truth = synthetic::random_truth(generator, scale);
      poses = synthetic::random_poses(truth, generator, regime.poses, rad_from_deg(60));
      synthetic::add_noise(poses, synthetic::tracker_and_camera(), scale, generator);
    }
    const auto which =
        synthetic::some_of(poses.size(), poses.size() / 5, regime.one_stretch, generator);
    const Pose& wanted = truth.solution.hand_from_eye;
    clean.add(table, synthetic::without(poses, which), mode, wanted);
    for (std::size_t k = 0; k < wrong.size(); ++k) {
      wrong[k].add(
          table,
          synthetic::spoiled(poses, which, synthetic::kSpoilings[k].spoiling, scale, generator),
          mode, wanted);
    }
  }
  double worst = 0;
  for (std::size_t k = 0; k < wrong.size(); ++k) {
    for (std::size_t m = 0; m < table.size(); ++m) {
      const double rotation = std::sqrt(wrong[k].rotation[m] / clean.rotation[m]);
      const double translation = std::sqrt(wrong[k].translation[m] / clean.translation[m]);
      worst = std::max({worst, rotation, translation});
      EXPECT_LE(rotation, kMostWorse)
          << table[m].name << ", " << regime.name << ", " << synthetic::kSpoilings[k].name;
      EXPECT_LE(translation, kMostWorse)
          << table[m].name << ", " << regime.name << ", " << synthetic::kSpoilings[k].name;
    }
  }
  ::testing::Test::RecordProperty("worst_ratio", std::to_string(worst));
}

constexpr Regime kRandom{"random poses", false, 20, false};
constexpr Regime kFreeHand{"free hand, one stretch wrong", true, 25, true};

TEST(Robustness, KnownScaleRandomPoses) {
  expect_unmoved(ScaleMode::kKnown, kRandom);
}
TEST(Robustness, KnownScaleFreeHand) {
  expect_unmoved(ScaleMode::kKnown, kFreeHand);
}
TEST(Robustness, UnknownScaleRandomPoses) {
  expect_unmoved(ScaleMode::kUnknown, kRandom);
}
TEST(Robustness, UnknownScaleFreeHand) {
  expect_unmoved(ScaleMode::kUnknown, kFreeHand);
}

}  // namespace
}  // namespace handeye
