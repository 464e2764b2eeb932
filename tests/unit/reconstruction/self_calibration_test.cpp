// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/self_calibration.hpp"

#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "daemon/geometry/projection.hpp"
#include "tests/unit/reconstruction/synthetic_tracks.hpp"

namespace handeye {
namespace {

using test::SyntheticOptions;
using test::SyntheticTracks;

CameraModel wide_angle() {
  return {640, 480, 420.0, 420.4, 330.0, 231.0, {-0.3, 0.08, 0.0, 0.0, 0.0}};
}

CameraModel barrel() {
  return {640, 480, 600.0, 600.3, 326.0, 235.0, {-0.3, 0.02, 0.0, 0.0, 0.0}};
}

Reconstruction calibrate(const SyntheticTracks& tracks, const CameraModel& start,
                         IntrinsicsMode mode) {
  SelfCalibration calibration(start, mode);
  for (const TrackedFrame& frame : tracks.frames) calibration.add(frame);
  return calibration.finish();
}

CameraModel size_alone() {
  CameraModel camera;
  camera.width = 640;
  camera.height = 480;
  return camera;
}

void expect_right(const Reconstruction& result, const CameraModel& truth) {
  ASSERT_EQ(result.state, ReconstructionState::kTracking);
  const Lens& lens = result.lens;
  const double error_px = focal_px(lens.camera) - focal_px(truth);
  std::printf("focal length off by %.3f %% (sigma %.3f %%), image by %.2f px\n",
              100 * error_px / focal_px(truth), 100 * lens.sigma.focal_px / focal_px(truth),
              largest_difference_px(truth, lens.camera));
  EXPECT_TRUE(lens.observable);
  EXPECT_LT(std::abs(error_px), 0.005 * focal_px(truth));
  EXPECT_LT(std::abs(error_px), 3.5 * lens.sigma.focal_px);
  CameraModel same_distortion = truth;
  same_distortion.distortion = lens.camera.distortion;
  EXPECT_LT(largest_difference_px(truth, same_distortion), 1.0);
}

/// Either the lens is right, or it is said to be unknown.
void expect_not_wrong(const Reconstruction& result, const CameraModel& truth) {
  const Lens& lens = result.lens;
  if (!lens.observable) return;
  const double error_px = std::abs(focal_px(lens.camera) - focal_px(truth));
  EXPECT_LT(error_px, 0.05 * focal_px(truth));
  EXPECT_LT(error_px, 4.0 * lens.sigma.focal_px);
}

class Lenses : public testing::TestWithParam<CameraModel> {};

TEST_P(Lenses, AreEstimatedFromTheSizeOfTheImage) {
  SyntheticOptions options;
  options.frames = 150;
  options.camera = GetParam();
  const SyntheticTracks tracks = test::synthesize(options, test::free_hand());
  expect_right(calibrate(tracks, size_alone(), IntrinsicsMode::kEstimate), GetParam());
}

TEST_P(Lenses, AreRefinedFromAPoorCalibration) {
  SyntheticOptions options;
  options.frames = 150;
  options.seed = 2;
  options.camera = GetParam();
  const SyntheticTracks tracks = test::synthesize(options, test::free_hand());
  CameraModel start = GetParam();
  start.fx *= 1.03;
  start.fy *= 1.03;
  start.cx += 10.0;
  start.cy -= 10.0;
  const Reconstruction result = calibrate(tracks, start, IntrinsicsMode::kRefine);
  EXPECT_EQ(result.lens.mode, IntrinsicsMode::kRefine);
  expect_right(result, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Some, Lenses, testing::Values(barrel(), wide_angle()));

TEST(SelfCalibration, SaysUnknownOfALensWithoutMotion) {
  SyntheticOptions options;
  options.frames = 60;
  const SyntheticTracks still =
      test::synthesize(options, [](double) { return test::free_hand()(0.0); });
  EXPECT_FALSE(calibrate(still, size_alone(), IntrinsicsMode::kEstimate).lens.observable);
}

class DegenerateMotion : public testing::TestWithParam<int> {};

TEST_P(DegenerateMotion, GivesNoWrongLens) {
  SyntheticOptions options;
  options.frames = 120;
  options.camera = barrel();
  options.relief_mm = GetParam() == 2 ? 0.0 : 8.0;
  const int kind = GetParam();
  const test::Motion motion = [kind](double time_s) {
    Pose room_from_eye = test::free_hand()(time_s);
    switch (kind) {
      case 0:  // turning on the spot
        room_from_eye.translation().setZero();
        break;
      case 1:  // forwards and back
        room_from_eye.linear().setIdentity();
        room_from_eye.translation() = Eigen::Vector3d(0, 0, 25.0 * std::sin(0.9 * time_s));
        break;
      default:  // parallel to a plane, without a turn
        room_from_eye.linear().setIdentity();
        room_from_eye.translation().z() = 0;
    }
    return room_from_eye;
  };
  const SyntheticTracks tracks = test::synthesize(options, motion);
  expect_not_wrong(calibrate(tracks, size_alone(), IntrinsicsMode::kEstimate), barrel());
}

INSTANTIATE_TEST_SUITE_P(Kinds, DegenerateMotion, testing::Range(0, 3));

TEST(SelfCalibration, IsBitIdenticalFromRunToRun) {
  SyntheticOptions options;
  options.frames = 60;
  const SyntheticTracks tracks = test::synthesize(options, test::free_hand());
  const Reconstruction first = calibrate(tracks, tracks.camera, IntrinsicsMode::kRefine);
  const Reconstruction second = calibrate(tracks, tracks.camera, IntrinsicsMode::kRefine);
  ASSERT_FALSE(first.frames.empty());
  EXPECT_EQ(first.lens.camera.fx, second.lens.camera.fx);
  EXPECT_EQ(first.lens.camera.distortion, second.lens.camera.distortion);
  EXPECT_EQ(first.frames.back().eye_from_scene.matrix(),
            second.frames.back().eye_from_scene.matrix());
}

}  // namespace
}  // namespace handeye
