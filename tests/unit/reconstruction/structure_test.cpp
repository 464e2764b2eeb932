// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "daemon/reconstruction/reconstruction.hpp"
#include "daemon/reconstruction/resection.hpp"
#include "tests/unit/reconstruction/synthetic_tracks.hpp"

/// What a reconstruction hands on beside its poses: the points, and what frames are worth.
namespace handeye {
namespace {

using test::SyntheticOptions;
using test::SyntheticTracks;

const RegisteredFrame& frame_of(const Reconstruction& whole, const ScenePoint::Observation& seen) {
  return whole.frames.at(static_cast<std::size_t>(seen.frame));
}

void expect_points_lie_where_keyframes_saw_them(const Reconstruction& whole,
                                                const SyntheticTracks& tracks) {
  ASSERT_EQ(whole.structure.size(), static_cast<std::size_t>(whole.points));
  const ReconstructionOptions defaults;
  for (const ScenePoint& point : whole.structure) {
    ASSERT_GE(point.observations.size(), 2U);
    int before = -1;
    for (const ScenePoint::Observation& seen : point.observations) {
      EXPECT_GT(seen.frame, before);
      before = seen.frame;
      const RegisteredFrame& frame = frame_of(whole, seen);
      EXPECT_TRUE(frame.keyframe);
      EXPECT_EQ(frame.part, point.part);
      const auto& seen_there = tracks.frames.at(static_cast<std::size_t>(frame.index)).observations;
      // Pixels are kept in single precision.
      EXPECT_TRUE(std::ranges::any_of(
          seen_there, [&](const auto& one) { return (one.pixel - seen.pixel).norm() < 1e-3; }));
      const Eigen::Vector2d expected =
          project<double>(tracks.camera, Eigen::Vector3d(frame.eye_from_scene * point.point_scene));
      EXPECT_LE((expected - seen.pixel).norm(), defaults.max_reprojection_px);
    }
  }
}

TEST(Structure, IsWhatTheKeyframesSaw) {
  SyntheticOptions options;
  options.frames = 100;
  const SyntheticTracks tracks = test::synthesize(options, test::free_hand());
  IncrementalReconstruction reconstruction(tracks.camera);
  for (const TrackedFrame& frame : tracks.frames) reconstruction.add(frame);
  expect_points_lie_where_keyframes_saw_them(reconstruction.finish(), tracks);
}

TEST(Structure, StaysWithItsPart) {
  SyntheticOptions options;
  options.frames = 240;
  options.blind_frame = 90;
  const SyntheticTracks tracks = test::synthesize(options, test::free_hand());
  IncrementalReconstruction reconstruction(tracks.camera);
  for (const TrackedFrame& frame : tracks.frames) reconstruction.add(frame);
  const Reconstruction whole = reconstruction.finish();
  ASSERT_EQ(whole.parts, 2);
  expect_points_lie_where_keyframes_saw_them(whole, tracks);
  for (const int part : {0, 1}) {
    EXPECT_GT(std::ranges::count(whole.structure, part, &ScenePoint::part), 100);
  }
}

TEST(Structure, IsThereOnTheWay) {
  SyntheticOptions options;
  options.frames = 60;
  const SyntheticTracks tracks = test::synthesize(options, test::free_hand());
  IncrementalReconstruction reconstruction(tracks.camera);
  for (const TrackedFrame& frame : tracks.frames) reconstruction.add(frame);
  const Reconstruction whole = reconstruction.current();
  ASSERT_EQ(whole.state, ReconstructionState::kTracking);
  EXPECT_EQ(whole.structure.size(), static_cast<std::size_t>(whole.points));
  EXPECT_GT(whole.structure.size(), 100U);
}

/// Larger with fewer features: their square root.
TEST(UnitCovariance, IsThatOfEveryFrame) {
  SyntheticOptions options;
  options.frames = 60;
  const SyntheticTracks tracks = test::synthesize(options, test::free_hand());
  IncrementalReconstruction reconstruction(tracks.camera);
  for (const TrackedFrame& frame : tracks.frames) reconstruction.add(frame);
  const Reconstruction whole = reconstruction.finish();
  ASSERT_EQ(whole.frames.size(), tracks.frames.size());
  for (const RegisteredFrame& frame : whole.frames) {
    EXPECT_EQ(Eigen::LLT<Matrix6d>(frame.unit_covariance).info(), Eigen::Success);
    // Some 200 features at 600 px: well below a milliradian a pixel, and not below what all of
    // them in the image's corners could give.
    const double rotation_rad = std::sqrt(frame.unit_covariance.topLeftCorner<3, 3>().trace());
    EXPECT_LT(rotation_rad, 0.003);
    EXPECT_GT(rotation_rad, 1.0 / 600.0 / std::sqrt(2.0 * frame.inliers));
  }
}

/// NEES of poses found from exact points, at a noise small enough for no robust loss to bite.
TEST(UnitCovariance, IsThatOfThePose) {
  constexpr int kTrials = 400;
  constexpr double kNoise_px = 0.2;
  const CameraModel camera{640, 480, 600, 600, 320, 240, {-0.1, 0.01, 0, 0, 0}};
  std::mt19937 random(11);
  std::uniform_real_distribution<double> side(-30, 30);
  std::normal_distribution<double> noise(0, kNoise_px);
  // Far from the scene's origin, where turning moves the translation too.
  const Pose truth = make_pose(Eigen::Quaterniond(0.9, 0.2, -0.3, 0.1), {25, -40, 60});
  double sum = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<PointMatch> matches;
    for (int i = 0; i < 60; ++i) {
      const Eigen::Vector3d point_eye(side(random), side(random), 80 + 0.3 * side(random));
      const Eigen::Vector2d error(noise(random), noise(random));
      matches.push_back({.point_scene = truth.inverse() * point_eye,
                         .pixel = project<double>(camera, point_eye) + error});
    }
    const auto found = resect(camera, matches, truth, {});
    ASSERT_TRUE(found);
    Vector6d error;
    error << log_so3(found->eye_from_scene.linear() * truth.linear().transpose()),
        found->eye_from_scene.translation() - truth.translation();
    sum += error.dot(found->unit_covariance.ldlt().solve(error)) / (kNoise_px * kNoise_px);
  }
  // Mean of 400 chi2 of 6 degrees of freedom: 6 +- 0.17; 99.9 % band.
  EXPECT_NEAR(sum / kTrials, 6.0, 3.3 * std::sqrt(12.0 / kTrials));
}

}  // namespace
}  // namespace handeye
