// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/geometry/camera_model.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <ceres/jet.h>
#include <gtest/gtest.h>

namespace handeye {
namespace {

CameraModel endoscope() {
  return {640, 480, 601.0, 603.5, 318.2, 242.9, {-0.32, 0.14, 1e-3, -8e-4, -0.02}};
}

TEST(Camera, ProjectsTheOpticalAxisToThePrincipalPoint) {
  const CameraModel camera = endoscope();
  const Eigen::Vector2d pixel = project<double>(camera, Eigen::Vector3d(0, 0, 75));
  EXPECT_DOUBLE_EQ(pixel.x(), camera.cx);
  EXPECT_DOUBLE_EQ(pixel.y(), camera.cy);
}

TEST(Camera, DistortsAsOpenCvDocuments) {
  // k1 = 0.1, k2 = 0.01, p1 = 0.001, p2 = 0.002, k3 = 0.0001 at (0.5, -0.25), worked out by hand:
  // r2 = 0.3125; radial = 1 + 0.03125 + 0.0009765625 + 0.0000030517578 = 1.0322296142578
  const Eigen::Vector2d d =
      distort<double>({0.1, 0.01, 0.001, 0.002, 0.0001}, Eigen::Vector2d(0.5, -0.25));
  EXPECT_NEAR(d.x(), 0.5 * 1.0322296142578 - 2 * 0.001 * 0.125 + 0.002 * (0.3125 + 0.5), 1e-12);
  EXPECT_NEAR(d.y(), -0.25 * 1.0322296142578 + 0.001 * (0.3125 + 0.125) - 2 * 0.002 * 0.125, 1e-12);
}

TEST(Camera, UnprojectUndoesProjectOverTheWholeImage) {
  const CameraModel camera = endoscope();
  for (int u = 0; u < camera.width; u += 29) {
    for (int v = 0; v < camera.height; v += 29) {
      const std::optional<Eigen::Vector2d> ray = unproject(camera, Eigen::Vector2d(u, v));
      ASSERT_TRUE(ray) << u << " " << v;
      const Eigen::Vector2d pixel =
          project<double>(camera, 80.0 * Eigen::Vector3d(ray->x(), ray->y(), 1.0));
      EXPECT_LT((pixel - Eigen::Vector2d(u, v)).norm(), 1e-9);
    }
  }
}

TEST(Camera, ProjectUndoesUnprojectForRandomLenses) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < 200; ++trial) {
    CameraModel camera = endoscope();
    camera.distortion = {0.3 * uniform(generator), 0.1 * uniform(generator),
                         1e-3 * uniform(generator), 1e-3 * uniform(generator),
                         0.02 * uniform(generator)};
    const Eigen::Vector2d normalised(0.4 * uniform(generator), 0.3 * uniform(generator));
    const Eigen::Vector2d pixel =
        project<double>(camera, Eigen::Vector3d(normalised.x(), normalised.y(), 1));
    const std::optional<Eigen::Vector2d> ray = unproject(camera, pixel);
    ASSERT_TRUE(ray);
    EXPECT_LT((*ray - normalised).norm(), 1e-11);
  }
}

TEST(Camera, UnprojectRefusesBeyondTheFoldOfTheLens) {
  CameraModel camera = endoscope();
  camera.distortion = {-0.5, 0, 0, 0, 0};
  // r (1 - 0.5 r^2) is largest, 0.544, at r = 0.816: no ray reaches beyond.
  EXPECT_TRUE(unproject(camera, {camera.cx + 0.5 * camera.fx, camera.cy}));
  EXPECT_FALSE(unproject(camera, {camera.cx + 0.6 * camera.fx, camera.cy}));
  EXPECT_FALSE(unproject(camera, {std::numeric_limits<double>::quiet_NaN(), 0}));
}

TEST(Camera, JetsDifferentiateTheProjection) {
  using Jet = ceres::Jet<double, 3>;
  const CameraModel camera = endoscope();
  const Eigen::Vector3d point(12, -9, 70);
  const Eigen::Matrix<Jet, 2, 1> pixel =
      project<Jet>(camera, {Jet(point.x(), 0), Jet(point.y(), 1), Jet(point.z(), 2)});
  const Eigen::Vector2d value = project<double>(camera, point);
  EXPECT_DOUBLE_EQ(pixel.x().a, value.x());
  EXPECT_DOUBLE_EQ(pixel.y().a, value.y());
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d step = 1e-4 * Eigen::Vector3d::Unit(axis);
    const Eigen::Vector2d slope =
        (project<double>(camera, point + step) - project<double>(camera, point - step)) / 2e-4;
    EXPECT_NEAR(pixel.x().v[axis], slope.x(), 1e-7);
    EXPECT_NEAR(pixel.y().v[axis], slope.y(), 1e-7);
  }
}

TEST(Camera, SaysWhatIsWrongWithIt) {
  EXPECT_FALSE(endoscope().problem());
  CameraModel camera = endoscope();
  camera.fx = 0;
  EXPECT_EQ(camera.problem(), "fx must be a positive number");
  camera = endoscope();
  camera.cy = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(camera.problem());
  camera = endoscope();
  camera.distortion[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(camera.problem());
  camera = endoscope();
  camera.width = 0;
  EXPECT_TRUE(camera.problem());
}

}  // namespace
}  // namespace handeye
