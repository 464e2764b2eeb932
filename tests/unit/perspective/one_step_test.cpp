// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/perspective/one_step.hpp"

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/unit/perspective/chung_simulation.hpp"
#include "tests/unit/perspective/scene.hpp"

namespace handeye {
namespace {

using namespace test;

PerspectiveCalibration solved(const Observations& observations,
                              const PerspectiveOptions& options = {}) {
  const auto found = calibrate_perspective(observations, options);
  if (const auto* refusal = std::get_if<PerspectiveRefusal>(&found)) {
    throw std::runtime_error("refused: " + refusal->advice);
  }
  return std::get<PerspectiveCalibration>(found);
}

void expect_exact(const Scene& scene) {
  const PerspectiveCalibration result = solved(scene.observations);
  const RefinedCalibration& found = result.refined;
  EXPECT_LT(rotation_angle_rad(found.hand_from_eye.linear(), scene.hand_from_eye.linear()), 1e-7);
  EXPECT_LT((found.hand_from_eye.translation() - scene.hand_from_eye.translation()).norm(), 1e-5);
  EXPECT_LT(rotation_angle_rad(found.object_from_hand.linear(), scene.object_from_hand.linear()),
            1e-7);
  EXPECT_LT((found.object_from_hand.translation() - scene.object_from_hand.translation()).norm(),
            1e-5);
  EXPECT_NEAR(found.camera.fx, 700.0, 1e-4);
  EXPECT_NEAR(found.camera.fy, 700.0, 1e-4);
  EXPECT_NEAR(found.camera.cx, 330.0, 1e-4);
  EXPECT_NEAR(found.camera.cy, 250.0, 1e-4);
  EXPECT_NEAR(found.camera.k1_per_mm2, 0.02, 1e-7);
  EXPECT_LT(found.reprojection_px, 1e-7);
  EXPECT_GT(result.iterations, 0);
}

TEST(OneStep, IsExactOnA3dObject) {
  expect_exact(Scene(false));
}

TEST(OneStep, IsExactOnAPlane) {
  expect_exact(Scene(true));
}

TEST(OneStep, ThreePositionsAreEnough) {
  expect_exact(Scene(false, 140.0, 3));
  expect_exact(Scene(true, 140.0, 3));
}

TEST(OneStep, IsExactAtAndAroundHalfATurn) {
  for (const double angle_deg : {0.0, 90.0, 179.0, 179.999999, 180.0, 180.5}) {
    SCOPED_TRACE(angle_deg);
    expect_exact(Scene(false, angle_deg));
  }
}

TEST(OneStep, AnswersThePapersSimulationExactly) {
  const PerspectiveCalibration result = solved(chung::observe({}));
  const auto ideal = chung::y_vector(chung::object_from_hand());
  const auto y = chung::y_vector(result.refined.object_from_hand);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(y(i) / ideal(i), 1.0, 1e-6) << i;
  EXPECT_LE(result.iterations, 6);
  EXPECT_NEAR(result.refined.camera.k1_per_mm2 / chung::kK1_per_mm2, 1.0, 1e-6);
}

TEST(OneStep, ANoisyFirstGuessOfTheRestIsReplacedByTheStartGiven) {
  PerspectiveOptions options;
  options.start.object_from_hand =
      chung::pose_of(0.75 * chung::y_vector(chung::object_from_hand()));
  options.start.k1_per_mm2 = 0.75 * chung::kK1_per_mm2;
  options.start.centre_px = 0.75 * chung::lens().centre_px;
  options.start.matrices = chung::matrices();
  for (PerspectiveMatrix& matrix : options.start.matrices) matrix(0, 0) *= 0.9;
  const PerspectiveCalibration result = solved(chung::observe({}), options);
  const auto ideal = chung::y_vector(chung::object_from_hand());
  const auto y = chung::y_vector(result.refined.object_from_hand);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(y(i) / ideal(i), 1.0, 1e-6) << i;
  EXPECT_LE(result.iterations, 6);
}

TEST(OneStep, IgnoringTheDistortionShowsInTheResiduals) {
  const Scene scene(false);
  const PerspectiveCalibration ignored = solved(scene.observations, {.distortion_inside = false});
  EXPECT_EQ(ignored.refined.camera.k1_per_mm2, 0.0);
  EXPECT_EQ(ignored.sigma.camera.k1_per_mm2, 0.0);
  EXPECT_GT(ignored.refined.reprojection_px, 0.1);
}

TEST(OneStep, FindsTheWidthOfAPixelThatIsKnownByItsNameOnly) {
  for (const double factor : {1.011, 0.95}) {
    Observations observations = chung::observe({});
    observations.pixel_mm.x() *= factor;
    const PerspectiveCalibration result = solved(observations);
    const auto ideal = chung::y_vector(chung::object_from_hand());
    const auto y = chung::y_vector(result.refined.object_from_hand);
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(y(i) / ideal(i), 1.0, 1e-6) << i;
    EXPECT_NEAR(result.pixel_mm.x() / chung::pixel_mm().x(), 1.0, 1e-6);
    EXPECT_NEAR(result.refined.camera.k1_per_mm2 / chung::kK1_per_mm2, 1.0, 1e-6);
  }
}

TEST(OneStep, KeepsTheWidthOfAPixelThatIsRight) {
  // A lens that is not round: twice as long a focal length in x.
  Scene scene(false);
  scene.observations.positions.clear();
  scene.anamorphic = 2.0;
  for (const Pose& hand : scene.hand1_from_hands) scene.add_position(hand, false);
  const PerspectiveCalibration result = solved(scene.observations);
  EXPECT_EQ(result.pixel_mm, scene.observations.pixel_mm);
  EXPECT_NEAR(result.refined.camera.fx / result.refined.camera.fy, 2.0, 1e-8);
  EXPECT_LT((result.refined.hand_from_eye.translation() - scene.hand_from_eye.translation()).norm(),
            1e-5);
}

/// Mean of (error / sigma)^2 over seeds: 1 when the sigmas are honest. Errors of hand_from_eye's
/// rotation and translation, whose sigmas are square roots of traces.
Eigen::Vector2d mean_square_errors(bool planar, double image_px, double hand_deg, double hand_mm,
                                   unsigned seeds) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (unsigned seed = 0; seed < seeds; ++seed) {
    Scene scene(planar, 140.0, 8);
    scene.with_image_noise(image_px, seed);
    if (hand_mm > 0) scene.with_hand_noise(hand_deg, hand_mm, 1000 + seed);
    const PerspectiveCalibration result = solved(scene.observations);
    const Pose& found = result.refined.hand_from_eye;
    const double rotation =
        deg_from_rad(rotation_angle_rad(found.linear(), scene.hand_from_eye.linear()));
    const double translation = (found.translation() - scene.hand_from_eye.translation()).norm();
    sum += Eigen::Vector2d(std::pow(rotation / result.sigma.hand_from_eye_deg, 2),
                           std::pow(translation / result.sigma.hand_from_eye_mm, 2));
  }
  return sum / seeds;
}

TEST(OneStep, GrossErrorsAreFoundAndLeftOut) {
  for (const bool planar : {false, true}) {
    Scene clean(planar);
    clean.with_image_noise(0.3, 1);
    Scene spoiled = clean;
    spoiled.observations.positions[1].points[7].pixel.x() += planar ? 30.0 : 100.0;
    const auto found = solved(spoiled.observations);
    EXPECT_EQ(found.left_out, std::vector<std::size_t>{36 + 7});
    spoiled = clean;
    spoiled.observations.positions[1].points[7].pixel.x() += 25.0;
    spoiled.observations.positions[4].points[0].pixel.y() -= 15.0;
    spoiled.observations.positions[4].points[35].pixel.y() += 20.0;
    const auto three = solved(spoiled.observations);
    EXPECT_EQ(three.left_out, (std::vector<std::size_t>{36 + 7, 4 * 36, 4 * 36 + 35}));
    const auto expected = solved(clean.observations);
    EXPECT_TRUE(expected.left_out.empty());
    EXPECT_LT(
        (three.refined.hand_from_eye.translation() - expected.refined.hand_from_eye.translation())
            .norm(),
        expected.sigma.hand_from_eye_mm);
  }
}

TEST(OneStep, APlaneBeginsAtTheMatricesGiven) {
  const Scene scene(true);
  const PerspectiveCalibration first = solved(scene.observations);
  PerspectiveOptions options;
  options.start.object_from_hand = first.matrix_object_from_hand;
  options.start.matrices = first.matrices;
  options.start.centre_px = scene.lens.centre_px;
  options.start.k1_per_mm2 = scene.lens.k1_per_mm2;
  const PerspectiveCalibration again = solved(scene.observations, options);
  EXPECT_LE(again.iterations, 2);
  EXPECT_LT(again.refined.reprojection_px, 1e-7);
  // A start that is used shows where it is bad.
  for (PerspectiveMatrix& matrix : options.start.matrices) matrix.row(0) *= 1.02;
  const PerspectiveCalibration off = solved(scene.observations, options);
  EXPECT_GT((off.matrices.front() - first.matrices.front()).norm(), 1e-3);
  EXPECT_LT(off.refined.reprojection_px, 1e-7);
}

TEST(OneStep, SigmasAreHonestUnderImageNoise) {
  for (const bool planar : {false, true}) {
    const Eigen::Vector2d ratio = mean_square_errors(planar, 0.3, 0.0, 0.0, 30);
    EXPECT_GT(ratio.minCoeff(), 0.5) << ratio.transpose();
    EXPECT_LT(ratio.maxCoeff(), 1.8) << ratio.transpose();
  }
}

TEST(OneStep, SigmasAreHonestUnderATrackersNoise) {
  const Eigen::Vector2d ratio = mean_square_errors(false, 0.3, 0.06, 0.15, 20);
  EXPECT_GT(ratio.minCoeff(), 0.4) << ratio.transpose();
  EXPECT_LT(ratio.maxCoeff(), 2.2) << ratio.transpose();
}

}  // namespace
}  // namespace handeye
