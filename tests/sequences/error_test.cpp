// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/simulator/random_stream.hpp"
#include "tests/sequences/lens_error.hpp"
#include "tests/sequences/pose_error.hpp"

namespace handeye::sequences {
namespace {

using simulator::Purpose;
using simulator::RandomStream;

/// Poses all over the place, and the same seen from another frame in another unit.
std::vector<PosePair> similar_pairs(RandomStream& random, double mm_per_unit) {
  const Pose other_from_scene = make_pose(random.rotation(), random.normal_vector(300));
  std::vector<PosePair> pairs;
  for (int i = 0; i < 50; ++i) {
    const Pose scene_from_eye = make_pose(random.rotation(), random.normal_vector(20));
    Pose other_from_eye = other_from_scene * scene_from_eye;
    other_from_eye.translation() /= mm_per_unit;
    pairs.push_back({scene_from_eye, other_from_eye});
  }
  return pairs;
}

TEST(PoseError, ASimilarityIsNoError) {
  RandomStream random(1, Purpose::kMotion);
  for (const double mm_per_unit : {0.01, 1.0, 370.0}) {
    const auto error = pose_error(similar_pairs(random, mm_per_unit), 80);
    ASSERT_TRUE(error.has_value());
    EXPECT_NEAR(error->mm_per_unit / mm_per_unit, 1, 1e-9);
    EXPECT_LT(error->rotation_worst_deg, 1e-5);
    EXPECT_LT(error->position_worst, 1e-9);
  }
}

TEST(PoseError, SaysHowFarOffPosesAre) {
  RandomStream random(2, Purpose::kMotion);
  std::vector<PosePair> pairs = similar_pairs(random, 5);
  for (PosePair& pair : pairs) {
    const Eigen::Vector3d turn = random.normal_vector(rad_from_deg(0.2));
    pair.estimated_scene_from_eye.linear() *= exp_so3(turn);
    pair.estimated_scene_from_eye.translation() += random.normal_vector(0.4 / 5);
  }
  pairs[7].estimated_scene_from_eye.linear() *= exp_so3(Eigen::Vector3d(0, rad_from_deg(30.0), 0));
  const PoseError error = pose_error(pairs, 80).value();
  EXPECT_NEAR(error.position_rms, std::sqrt(3.0) * 0.4 / 80, 0.001);
  EXPECT_GT(error.position_worst, error.position_rms);
  EXPECT_LT(error.position_worst, 3 * error.position_rms);
  EXPECT_NEAR(error.rotation_worst_deg, 30, 1.5);
  // 30 degrees in one of fifty, and the noise in all.
  EXPECT_NEAR(error.rotation_rms_deg, std::sqrt(900.0 / 50 + 3 * 0.04), 0.4);
}

TEST(PoseError, TurningIsWhatOrientationsAloneSay) {
  RandomStream random(5, Purpose::kMotion);
  std::vector<PosePair> pairs = similar_pairs(random, 5);
  // One and the same turn of all orientations, which the positions do not share.
  const Eigen::Matrix3d turn = exp_so3(rad_from_deg(2.0) * Eigen::Vector3d::UnitX());
  for (PosePair& pair : pairs) {
    pair.estimated_scene_from_eye.linear() = turn * pair.estimated_scene_from_eye.linear();
  }
  const PoseError error = pose_error(pairs, 80).value();
  EXPECT_NEAR(error.rotation_rms_deg, 2, 1e-5);
  EXPECT_LT(error.turning_worst_deg, 1e-5);
  EXPECT_LT(error.position_worst, 1e-9);
}

TEST(PoseError, AMirroredSceneIsAnError) {
  RandomStream random(3, Purpose::kMotion);
  std::vector<PosePair> pairs = similar_pairs(random, 1);
  for (PosePair& pair : pairs) pair.estimated_scene_from_eye.translation().x() *= -1;
  EXPECT_GT(pose_error(pairs, 80).value().position_rms, 0.05);
}

TEST(PoseError, NothingWhereNoSimilarityIsDefined) {
  RandomStream random(4, Purpose::kMotion);
  std::vector<PosePair> pairs = similar_pairs(random, 1);
  EXPECT_FALSE(pose_error(std::span(pairs).first(2), 80).has_value());
  for (PosePair& pair : pairs) pair.estimated_scene_from_eye.translation().setZero();
  EXPECT_FALSE(pose_error(pairs, 80).has_value());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i].true_scene_from_eye.translation() = static_cast<double>(i) * Eigen::Vector3d(1, 2, 3);
  }
  EXPECT_FALSE(pose_error(pairs, 80).has_value());
}

const CameraModel kCamera{640, 480, 600, 601, 322, 238, {-0.3, 0.05, 0, 0, 0}};

TEST(LensError, IsZeroForTheTruth) {
  const LensError error = lens_error(kCamera, kCamera);
  EXPECT_EQ(error.focal_percent, 0);
  EXPECT_LT(error.ray_px, 1e-9);
  EXPECT_LT(error.distortion_px, 1e-9);
}

TEST(LensError, TellsFocalLengthFromDistortion) {
  CameraModel longer = kCamera;
  longer.fx *= 1.004;
  longer.fy *= 0.99;
  longer.cx += 3;
  LensError error = lens_error(kCamera, longer);
  EXPECT_NEAR(error.focal_percent, 1.0, 1e-9);
  EXPECT_LT(error.distortion_px, 1e-9);
  EXPECT_GT(error.ray_px, 3);

  CameraModel straighter = kCamera;
  straighter.distortion[0] = -0.28;
  error = lens_error(kCamera, straighter);
  EXPECT_EQ(error.focal_percent, 0);
  EXPECT_EQ(error.distortion_px, error.ray_px);
  // At the corner farthest from the centre: f dk1 r^3.
  const Eigen::Vector2d ray = unproject(kCamera, {0, 479}).value();
  EXPECT_NEAR(error.distortion_px, 600 * 0.02 * std::pow(ray.norm(), 3), 0.1);
}

TEST(LensError, LooksNoFartherThanTheFieldOfView) {
  CameraModel straighter = kCamera;
  straighter.distortion[0] = -0.28;
  cv::Mat1b middle(480, 640, static_cast<std::uint8_t>(0));
  middle(cv::Rect(220, 140, 200, 200)).setTo(255);
  EXPECT_LT(lens_error(kCamera, straighter, middle).distortion_px, 0.2);
  EXPECT_GT(lens_error(kCamera, straighter, middle).distortion_px, 0.01);
  EXPECT_EQ(lens_error(kCamera, straighter, cv::Mat1b(480, 640, 1)).distortion_px,
            lens_error(kCamera, straighter).distortion_px);
}

}  // namespace
}  // namespace handeye::sequences
