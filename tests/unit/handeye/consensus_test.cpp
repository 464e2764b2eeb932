// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/consensus.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/handeye/spoiled.hpp"
#include "tests/unit/handeye/synthetic.hpp"

namespace handeye {
namespace {

struct Scene {
  std::string name;
  std::vector<PosePair> poses;
};

/// Clean but for noise: 0, that of tracker and camera, and twenty times as much.
std::vector<Scene> scenes(double scale, std::uint32_t seed) {
  std::vector<Scene> result;
  const synthetic::Truth scope = synthetic::scope(scale);
  result.push_back({"free hand", synthetic::record(scope, synthetic::free_hand, 100,
                                                   synthetic::tracker_and_camera(), seed)
                                     .poses()});
  std::mt19937 generator(seed);
  for (const double factor : {0.0, 1.0, 20.0}) {
    const synthetic::Truth truth = synthetic::random_truth(generator, scale);
    auto poses = synthetic::random_poses(truth, generator, 30, rad_from_deg(60));
    const PoseNoise one = synthetic::tracker_and_camera();
    synthetic::add_noise(poses,
                         {factor * one.hand_rotation_rad, factor * one.hand_translation_mm,
                          factor * one.eye_rotation_rad, factor * one.eye_translation_mm},
                         scale, generator);
    std::string name = "random poses, noise times ";
    name += std::to_string(factor);
    result.push_back({std::move(name), std::move(poses)});
  }
  return result;
}

double scale_of(ScaleMode mode) {
  return mode == ScaleMode::kKnown ? 1.0 : 0.02;
}

constexpr std::array<ScaleMode, 2> kModes{ScaleMode::kKnown, ScaleMode::kUnknown};

TEST(Consensus, KeepsGoodPoses) {
  std::size_t lost = 0;
  std::size_t total = 0;
  for (const ScaleMode mode : kModes) {
    for (std::uint32_t seed = 0; seed < 50; ++seed) {
      for (const Scene& scene : scenes(scale_of(mode), seed)) {
        lost += wrong_poses(scene.poses, {.scale = mode}).size();
        total += scene.poses.size();
      }
    }
  }
  RecordProperty("lost_per_million", static_cast<int>(1000000 * lost / total));
  EXPECT_LT(static_cast<double>(lost), 0.005 * static_cast<double>(total));
}

TEST(Consensus, KeepsAllExactPoses) {
  std::mt19937 generator(3);
  for (const double scale : {1e-6, 1.0, 1e6}) {
    for (const double angle_deg : {5.0, 60.0, 180.0}) {
      const synthetic::Truth truth = synthetic::random_truth(generator, scale);
      const auto poses = synthetic::random_poses(truth, generator, 40, rad_from_deg(angle_deg));
      EXPECT_TRUE(wrong_poses(poses).empty()) << scale << " " << angle_deg;
    }
  }
}

/// At twenty times the noise 30 mm and 5 deg are no gross errors any more: there, those only that
/// are.
TEST(Consensus, FindsAFifthOfWrongPoses) {
  for (const ScaleMode mode : kModes) {
    const double scale = scale_of(mode);
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
      std::mt19937 generator(seed);
      for (const Scene& scene : scenes(scale, seed)) {
        const bool noisy = scene.name.find("20.0") != std::string::npos;
        for (const auto& [spoiling, name] : synthetic::kSpoilings) {
          const bool moderate = spoiling == synthetic::Spoiling::kEyeTranslation ||
                                spoiling == synthetic::Spoiling::kEyeRotation;
          if (noisy && moderate) continue;
          const auto which =
              synthetic::some_of(scene.poses.size(), scene.poses.size() / 5, seed % 2, generator);
          const auto poses = synthetic::spoiled(scene.poses, which, spoiling, scale, generator);
          const auto wrong = wrong_poses(poses, {.scale = mode});
          EXPECT_TRUE(std::includes(wrong.begin(), wrong.end(), which.begin(), which.end()))
              << scene.name << ", " << name << ", seed " << seed;
          EXPECT_LE(wrong.size(), which.size() + 2) << scene.name << ", " << name;
        }
      }
    }
  }
}

TEST(Consensus, DoesNotDependOnTheOrder) {
  for (const ScaleMode mode : kModes) {
    std::mt19937 generator(8);
    const double scale = scale_of(mode);
    for (const int count : {30, 150}) {
      auto poses =
          synthetic::random_poses(synthetic::scope(scale), generator, count, rad_from_deg(60));
      synthetic::add_noise(poses, synthetic::tracker_and_camera(), scale, generator);
      // A wrong shift of about the size that decides whether a pose is right.
      for (std::size_t k = 0; k < poses.size(); k += 4) {
        poses[k].eye_from_scene.translation().x() += 0.05 * static_cast<double>(k % 40) * scale;
      }
      const Consensus given = find_consensus(poses, {.scale = mode});
      std::vector<std::size_t> order(poses.size());
      std::iota(order.begin(), order.end(), 0);
      for (int trial = 0; trial < 10; ++trial) {
        std::shuffle(order.begin(), order.end(), generator);
        std::vector<PosePair> shuffled;
        for (const std::size_t i : order) shuffled.push_back(poses[i]);
        const Consensus found = find_consensus(shuffled, {.scale = mode});
        std::vector<std::size_t> wrong;
        for (const std::size_t i : found.wrong) wrong.push_back(order[i]);
        std::sort(wrong.begin(), wrong.end());
        EXPECT_EQ(wrong, given.wrong) << count << " poses";
        EXPECT_EQ(found.agreement.mm_per_unit, given.agreement.mm_per_unit);
      }
    }
  }
}

TEST(Consensus, CountsNumbersThatAreNoPosesAsWrong) {
  std::mt19937 generator(4);
  auto poses = synthetic::random_poses(synthetic::scope(), generator, 20, rad_from_deg(60));
  poses[3].eye_from_scene.translation().x() = std::numeric_limits<double>::quiet_NaN();
  poses[11].room_from_hand.matrix()(0, 0) = std::numeric_limits<double>::infinity();
  poses[12].room_from_hand.linear().setZero();
  poses[15].eye_from_scene.linear().col(2) *= -1.0;
  EXPECT_EQ(wrong_poses(poses), (std::vector<std::size_t>{3, 11, 12, 15}));
  EXPECT_EQ(wrong_poses(std::span(poses).subspan(10, 3)), (std::vector<std::size_t>{1, 2}));
}

TEST(Consensus, AccusesNobodyWithoutAMajority) {
  std::mt19937 generator(5);
  auto poses = synthetic::random_poses(synthetic::scope(), generator, 40, rad_from_deg(60));
  std::vector<std::size_t> all(poses.size());
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = k;
  poses = synthetic::spoiled(poses, all, synthetic::Spoiling::kRandomHand, 1.0, generator);
  EXPECT_LT(wrong_poses(poses).size(), poses.size() / 2);
  EXPECT_TRUE(wrong_poses({}).empty());
  EXPECT_TRUE(wrong_poses(std::span(poses).first(1)).empty());
  EXPECT_TRUE(wrong_poses(std::span(poses).first(3)).empty());
}

TEST(Consensus, EstimatesScaleAndNoise) {
  std::mt19937 generator(6);
  auto poses = synthetic::random_poses(synthetic::scope(0.02), generator, 100, rad_from_deg(60));
  const PoseNoise noise = synthetic::tracker_and_camera();
  synthetic::add_noise(poses, noise, 0.02, generator);
  const ScrewAgreement agreement = find_consensus(poses).agreement;
  EXPECT_NEAR(agreement.mm_per_unit, 50.0, 0.5);
  // Four poses' noise in a movement's two angles.
  const double expected_rad =
      std::sqrt(2.0) * std::hypot(noise.hand_rotation_rad, noise.eye_rotation_rad);
  EXPECT_NEAR(agreement.angle_sigma_rad, expected_rad, 0.15 * expected_rad);
}

TEST(Consensus, FindsTheGrossErrorsOfRealPoses) {
  const auto poses = synthetic::real_poses("outliers_camodocal.csv");
  if (poses.empty()) GTEST_SKIP() << "no poses/outliers_camodocal.csv";
  for (const ScaleMode mode : kModes) {
    EXPECT_EQ(wrong_poses(poses, {.scale = mode}), std::vector<std::size_t>{36});
  }
}

TEST(Consensus, KeepsTheRealPosesOfRobotsAndALaparoscope) {
  for (const char* name : {"moveit.csv", "visp_franka.csv", "laparoscope.csv"}) {
    const auto poses = synthetic::real_poses(name);
    if (poses.empty()) GTEST_SKIP() << "no poses/" << name;
    for (const ScaleMode mode : kModes) {
      EXPECT_TRUE(wrong_poses(poses, {.scale = mode}).empty()) << name;
    }
  }
  // Hand-held, with real slips: few.
  EXPECT_LE(wrong_poses(synthetic::real_poses("vicon_primesense.csv")).size(), 12U);
}

}  // namespace
}  // namespace handeye
