// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdio>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "daemon/geometry/projection.hpp"
#include "daemon/reconstruction/frame_record.hpp"
#include "daemon/reconstruction/lens_fit.hpp"
#include "daemon/reconstruction/lens_information.hpp"
#include "tests/unit/reconstruction/synthetic_tracks.hpp"

namespace handeye {
namespace {

using test::SyntheticOptions;
using test::SyntheticTracks;

CameraModel barrel() {
  return {640, 480, 600.0, 601.0, 326.0, 235.0, {-0.3, 0.05, 0.0, 0.0, 0.0}};
}

/// Every fourth frame as a keyframe at its true pose.
Scene true_scene(const SyntheticTracks& tracks, const CameraModel& camera) {
  Scene scene;
  for (std::size_t i = 0; i < tracks.frames.size(); i += 4) {
    scene.add_keyframe(camera, make_record(tracks.frames[i]), tracks.eye_from_room[i], 0.0);
  }
  return scene;
}

LensVector errors_in_sigmas(const LensVector& error, const LensMatrix& covariance) {
  return error.cwiseQuotient(covariance.diagonal().cwiseSqrt());
}

TEST(LensParameters, ComeBackFromTheCamera) {
  const CameraModel camera = barrel();
  const CameraModel again = with_lens(plain_camera(640, 480, 1.0), lens_vector(camera));
  EXPECT_NEAR(again.fx, camera.fx, 1e-9);
  EXPECT_NEAR(again.fy, camera.fy, 1e-9);
  EXPECT_NEAR(largest_difference_px(camera, again), 0.0, 1e-9);
}

TEST(LensParameters, MovePixelsByTheirDerivative) {
  const CameraModel camera = barrel();
  const Eigen::Vector3d point(18.0, -23.0, 70.0);
  const auto by_lens = pixel_by_lens(camera, point);
  for (int i = 0; i < kLensParameters; ++i) {
    const LensVector step = 1e-5 * LensVector::Unit(i);
    const Eigen::Vector2d slope =
        (project<double>(with_lens(camera, lens_vector(camera) + step), point) -
         project<double>(with_lens(camera, lens_vector(camera) - step), point)) /
        2e-5;
    EXPECT_LT((by_lens.col(i) - slope).norm(), 1e-5 * (1.0 + slope.norm())) << "parameter " << i;
  }
}

TEST(LensAdjustment, FindsTheLensWithPosesAndPoints) {
  SyntheticOptions options;
  options.frames = 120;
  options.camera = barrel();
  const SyntheticTracks tracks = test::synthesize(options, test::free_hand());
  CameraModel camera = plain_camera(640, 480, rad_from_deg(65.0));
  Scene scene = true_scene(tracks, camera);
  fit_lens(lens_prior(camera, IntrinsicsMode::kEstimate), true, {}, scene, camera);
  polish_lens(lens_prior(camera, IntrinsicsMode::kEstimate), {}, scene, camera);
  EXPECT_NEAR(focal_px(camera) / focal_px(barrel()), 1.0, 0.005);
  EXPECT_LT(largest_difference_px(barrel(), camera), 3.0);
}

TEST(LensAdjustment, LeavesAloneWhatIsNotFree) {
  SyntheticOptions options;
  options.frames = 60;
  options.camera = barrel();
  const SyntheticTracks tracks = test::synthesize(options, test::free_hand());
  CameraModel camera = barrel();
  camera.fx *= 1.02;
  camera.fy *= 1.02;
  const CameraModel before = camera;
  Scene scene = true_scene(tracks, camera);
  fit_lens(lens_prior(camera, IntrinsicsMode::kRefine), false, {}, scene, camera);
  EXPECT_NE(camera.fx, before.fx);
  EXPECT_NE(camera.distortion[0], before.distortion[0]);
  EXPECT_EQ(camera.cx, before.cx);
  EXPECT_EQ(camera.distortion[1], before.distortion[1]);
}

/// Squared errors in units of their covariance over many draws of noise: 6 on average.
TEST(LensInformation, IsHonest) {
  constexpr int kSeeds = 16;
  double nees = 0.0;
  LensVector squares = LensVector::Zero();
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    SyntheticOptions options;
    options.seed = seed;
    options.frames = 100;
    options.camera = barrel();
    const SyntheticTracks tracks = test::synthesize(options, test::free_hand());
    CameraModel camera = barrel();
    Scene scene = true_scene(tracks, camera);
    const LensPrior prior = lens_prior(camera, IntrinsicsMode::kRefine);
    polish_lens(prior, {}, scene, camera);
    const auto information =
        lens_information(camera, {whole_lens(), prior}, ReconstructionOptions{}.robust_px, scene);
    ASSERT_TRUE(information);
    const LensVector error = lens_vector(camera) - lens_vector(barrel());
    nees += error.dot(information->covariance.ldlt().solve(error)) / kSeeds;
    squares += errors_in_sigmas(error, information->covariance).cwiseAbs2() / kSeeds;
  }
  std::printf("NEES %.2f of 6; rms in sigmas f %.2f c %.2f %.2f k1 %.2f k2 %.2f\n", nees,
              std::sqrt(squares[kFocal]), std::sqrt(squares[kCentreX]),
              std::sqrt(squares[kCentreY]), std::sqrt(squares[kK1]), std::sqrt(squares[kK2]));
  // Chi2 of 96 degrees of freedom over 16: within 3.1 and 9.7 in 999 of 1000 cases. The covariance
  // takes the larger of two, so it may be too large, not too small.
  EXPECT_LT(nees, 9.7);
  EXPECT_GT(nees, 1.5);
}

/// The response of the poses is what an adjustment with another lens does.
TEST(LensInformation, KnowsWhatPosesDoWhenTheLensChanges) {
  SyntheticOptions options;
  options.frames = 80;
  options.camera = barrel();
  options.outlier_tracks = 0;
  const SyntheticTracks tracks = test::synthesize(options, test::free_hand());
  CameraModel camera = barrel();
  Scene scene = true_scene(tracks, camera);
  const LensPrior prior = lens_prior(camera, IntrinsicsMode::kRefine);
  polish_lens(prior, {}, scene, camera);
  const auto information = lens_information(camera, {whole_lens(), prior}, 1.5, scene);
  ASSERT_TRUE(information);
  LensVector change = LensVector::Zero();
  change[kFocal] = 2.0;
  const CameraModel other = with_lens(camera, lens_vector(camera) + change);
  Scene moved = scene;
  moved.refresh_rays(other);
  adjust(other, AdjustmentOptions{}, moved);
  const auto turn = [](const Scene& of, std::size_t k) -> Eigen::Matrix3d {
    return of.keyframes[k].eye_from_scene.linear() *
           of.keyframes.front().eye_from_scene.linear().transpose();
  };
  for (std::size_t k = 1; k < scene.keyframes.size(); ++k) {
    const Eigen::Vector3d expected =
        (information->pose_by_lens[k] * change).head<3>() -
        turn(scene, k) * (information->pose_by_lens.front() * change).head<3>();
    const Eigen::Vector3d found = log_so3(turn(moved, k) * turn(scene, k).transpose());
    EXPECT_LT((found - expected).norm(), 0.15 * found.norm() + rad_from_deg(0.003)) << k;
  }
}

}  // namespace
}  // namespace handeye
