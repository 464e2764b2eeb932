// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/perspective/perspective_matrix.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace handeye {
namespace {

Pose eye_from_object() {
  return make_pose({0.9, 0.2, -0.3, 0.1}, {20, -30, 400});
}

Eigen::Matrix3d intrinsics() {
  Eigen::Matrix3d k;
  k << 8.0, 0.01, 0.2, 0.0, 8.5, -0.1, 0.0, 0.0, 1.0;
  return k;
}

std::vector<Eigen::Vector3d> box_points(double depth_mm) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 27; ++i) {
    points.emplace_back(1000.0 + 30.0 * (i % 3), 20.0 * (i / 3 % 3), depth_mm * (i / 9));
  }
  return points;
}

std::vector<Eigen::Vector2d> images(const PerspectiveMatrix& matrix,
                                    const std::vector<Eigen::Vector3d>& points) {
  std::vector<Eigen::Vector2d> all;
  for (const Eigen::Vector3d& point : points) {
    all.emplace_back((matrix * point.homogeneous()).hnormalized());
  }
  return all;
}

TEST(PerspectiveMatrix, DltFindsTheMatrixOfExactImages) {
  const Pose near_the_points = eye_from_object() * Eigen::Translation3d(-1030, -20, -20);
  const PerspectiveMatrix matrix = compose(intrinsics(), near_the_points);
  const auto points = box_points(20.0);
  const auto found = perspective_matrix(points, images(matrix, points));
  ASSERT_TRUE(found);
  EXPECT_LT((*found - matrix).norm() / matrix.norm(), 1e-10);
}

TEST(PerspectiveMatrix, APlaneOrTooFewPointsDetermineNone) {
  const PerspectiveMatrix matrix = compose(intrinsics(), eye_from_object());
  const auto plane = box_points(0.0);
  EXPECT_TRUE(coplanar(plane));
  EXPECT_FALSE(perspective_matrix(plane, images(matrix, plane)));
  auto few = box_points(20.0);
  few.resize(5);
  EXPECT_FALSE(perspective_matrix(few, images(matrix, few)));
  const std::vector<Eigen::Vector3d> same(10, Eigen::Vector3d(1, 2, 3));
  EXPECT_FALSE(perspective_matrix(same, images(matrix, same)));
}

TEST(PerspectiveMatrix, TakenApartItGivesWhatItWasMadeOf) {
  const auto parts = decompose(compose(intrinsics(), eye_from_object()));
  ASSERT_TRUE(parts);
  EXPECT_LT((parts->intrinsics - intrinsics()).norm(), 1e-12);
  EXPECT_TRUE(parts->eye_from_object.isApprox(eye_from_object(), 1e-12));
}

TEST(PerspectiveMatrix, AMirroredImageIsNotTakenApart) {
  const Eigen::Matrix3d mirrored = intrinsics() * Eigen::Vector3d(1, -1, 1).asDiagonal();
  EXPECT_FALSE(decompose(compose(mirrored, eye_from_object())));
}

TEST(PerspectiveMatrix, NormalisedHasThirdRowOfNormOneAndPositiveDepth) {
  const PerspectiveMatrix matrix = compose(intrinsics(), eye_from_object());
  const auto found = normalised(-7.0 * matrix, {0, 0, 0});
  ASSERT_TRUE(found);
  EXPECT_LT((*found - matrix).norm(), 1e-12);
  EXPECT_FALSE(normalised(PerspectiveMatrix::Zero(), {0, 0, 0}));
}

}  // namespace
}  // namespace handeye
