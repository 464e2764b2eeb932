// SPDX-License-Identifier: BSD-3-Clause
#include <random>

#include <gtest/gtest.h>

#include "daemon/adjustment/pose_manifold.hpp"
#include "daemon/geometry/projection.hpp"
#include "daemon/reconstruction/resection.hpp"
#include "daemon/reconstruction/triangulation.hpp"
#include "daemon/reconstruction/two_view.hpp"

namespace handeye {
namespace {

CameraModel camera() {
  return {640, 480, 560, 562, 322, 238, {-0.25, 0.08, 0.0005, -0.0003, 0.01}};
}

Pose some_pose(double angle_rad, const Eigen::Vector3d& translation) {
  Pose pose = Pose::Identity();
  pose.linear() = exp_so3(angle_rad * Eigen::Vector3d(0.3, -0.8, 0.5).normalized());
  pose.translation() = translation;
  return pose;
}

std::vector<Eigen::Vector3d> cloud(int count, double relief, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    const double x = 35.0 * uniform(random);
    const double y = 25.0 * uniform(random);
    points.emplace_back(x, y, 80.0 + relief * uniform(random));
  }
  return points;
}

TEST(Projection, DerivativeAgreesWithDifferences) {
  for (const Eigen::Vector3d& point : cloud(20, 30.0, 1)) {
    const Projection projection = project_with_derivative(camera(), point);
    EXPECT_LT((projection.pixel - project<double>(camera(), point)).norm(), 1e-9);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = 1e-5 * Eigen::Vector3d::Unit(axis);
      const Eigen::Vector2d slope =
          (project<double>(camera(), point + step) - project<double>(camera(), point - step)) /
          2e-5;
      EXPECT_LT((projection.by_point_eye.col(axis) - slope).norm(), 1e-5);
    }
  }
}

TEST(PoseManifold, PlusAndMinusAreInverse) {
  for (const int fixed_axis : {-1, 0, 1, 2}) {
    const PoseManifold manifold(fixed_axis);
    const PoseParameters x = to_parameters(some_pose(0.7, {1, 2, 3}));
    Eigen::VectorXd delta(manifold.TangentSize());
    for (int i = 0; i < delta.size(); ++i) delta(i) = 0.1 * (i + 1);
    PoseParameters moved{};
    ASSERT_TRUE(manifold.Plus(x.data(), delta.data(), moved.data()));
    Eigen::VectorXd back(manifold.TangentSize());
    ASSERT_TRUE(manifold.Minus(moved.data(), x.data(), back.data()));
    EXPECT_LT((back - delta).norm(), 1e-12);
    if (fixed_axis >= 0) {
      const auto held = static_cast<std::size_t>(4 + fixed_axis);
      EXPECT_EQ(moved[held], x[held]);
    }
    const Pose pose = to_pose(x.data());
    EXPECT_LT((pose.matrix() - some_pose(0.7, {1, 2, 3}).matrix()).norm(), 1e-12);
  }
}

TEST(Triangulation, FindsThePointAndItsAngle) {
  const Pose first = Pose::Identity();
  const Pose second = some_pose(0.1, {-12, 3, 1});
  for (const Eigen::Vector3d& point : cloud(20, 10.0, 2)) {
    const std::vector<PosedRay> rays{{&first, (first * point).hnormalized()},
                                     {&second, (second * point).hnormalized()}};
    const auto found = triangulate(rays);
    ASSERT_TRUE(found);
    EXPECT_LT((*found - point).norm(), 1e-6);
    const Eigen::Vector3d other = point - second.inverse().translation();
    const double angle = std::acos(point.normalized().dot(other.normalized()));
    EXPECT_NEAR(triangulation_angle_rad(rays, *found), angle, 1e-6);
  }
}

TEST(Triangulation, RefusesParallelRaysAndPointsBehind) {
  const Pose first = Pose::Identity();
  const Pose second = some_pose(0.0, {-10, 0, 0});
  const std::vector<PosedRay> parallel{{&first, {0.1, 0.1}}, {&second, {0.1, 0.1}}};
  EXPECT_FALSE(triangulate(parallel));
  const std::vector<PosedRay> diverging{{&first, {-0.1, 0.0}}, {&second, {0.1, 0.0}}};
  EXPECT_FALSE(triangulate(diverging));
}

std::vector<PointMatch> matches_at(const Pose& eye_from_scene, int outliers) {
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0.0, 0.3);
  std::uniform_real_distribution<double> wild(20.0, 150.0);
  std::vector<PointMatch> matches;
  for (const Eigen::Vector3d& point : cloud(100, 10.0, 3)) {
    Eigen::Vector2d pixel = project<double>(camera(), Eigen::Vector3d(eye_from_scene * point));
    pixel += Eigen::Vector2d(noise(random), noise(random));
    if (static_cast<int>(matches.size()) < outliers) {
      pixel += Eigen::Vector2d(wild(random), wild(random));
    }
    matches.push_back({point, pixel});
  }
  return matches;
}

TEST(Resection, WithstandsOutliers) {
  const Pose truth = some_pose(0.15, {4, -3, 6});
  const auto matches = matches_at(truth, 25);
  const auto found = refine_pose(camera(), matches, some_pose(0.12, {3, -2, 5}), {});
  ASSERT_TRUE(found);
  EXPECT_GE(found->inliers, 73);
  EXPECT_LE(found->inliers, 75);
  EXPECT_LT(deg_from_rad(rotation_angle_rad(found->eye_from_scene.linear(), truth.linear())), 0.3);
  EXPECT_LT(found->reprojection_px, 0.6);
}

TEST(Resection, NeedsNoPrediction) {
  const Pose truth = some_pose(0.5, {20, -10, 15});
  const auto found = resect(camera(), matches_at(truth, 30), some_pose(-1.5, {-80, 40, 0}), {});
  ASSERT_TRUE(found);
  EXPECT_LT(deg_from_rad(rotation_angle_rad(found->eye_from_scene.linear(), truth.linear())), 0.3);
}

TEST(Resection, RefusesMatchesThatDoNotAgree) {
  auto matches = matches_at(some_pose(0.1, {0, 0, 0}), 100);
  EXPECT_FALSE(resect(camera(), matches, Pose::Identity(), {}));
  matches.resize(10);
  EXPECT_FALSE(resect(camera(), matches, Pose::Identity(), {}));
}

std::vector<RayPair> pairs_of(const Pose& second_from_first, double relief) {
  std::mt19937 random(8);
  std::normal_distribution<double> noise(0.0, 0.3 / 560.0);
  std::vector<RayPair> pairs;
  for (const Eigen::Vector3d& point : cloud(150, relief, 6)) {
    RayPair pair{point.hnormalized(), (second_from_first * point).eval().hnormalized()};
    pair.first += Eigen::Vector2d(noise(random), noise(random));
    pair.second += Eigen::Vector2d(noise(random), noise(random));
    pairs.push_back(pair);
  }
  return pairs;
}

TEST(TwoView, FindsTheMotionInFrontOfReliefAndPlane) {
  const Pose truth = some_pose(0.12, {-12, 4, 3});
  for (const double relief : {12.0, 0.0}) {
    bool found = false;
    for (const TwoViewMotion& motion : two_view_motions(pairs_of(truth, relief), 1.0 / 560.0)) {
      const double rotation_deg =
          deg_from_rad(rotation_angle_rad(motion.second_from_first.linear(), truth.linear()));
      const double cosine =
          motion.second_from_first.translation().dot(truth.translation().normalized());
      found = found || (rotation_deg < 1.5 && cosine > 0.99 && motion.inlier_ratio > 0.7);
    }
    EXPECT_TRUE(found) << "relief " << relief;
  }
}

TEST(TwoView, TellsARotationFromAMotion) {
  const double threshold_rad = 2.0 / 560.0;
  const Pose turned = some_pose(0.2, {0, 0, 0});
  const RotationFit fit = fit_rotation(pairs_of(turned, 12.0), threshold_rad);
  EXPECT_GT(fit.inlier_ratio, 0.95);
  EXPECT_LT(deg_from_rad(rotation_angle_rad(fit.second_from_first, turned.linear())), 0.1);
  EXPECT_LT(fit_rotation(pairs_of(some_pose(0.2, {-12, 4, 3}), 12.0), threshold_rad).inlier_ratio,
            0.8);
}

}  // namespace
}  // namespace handeye
