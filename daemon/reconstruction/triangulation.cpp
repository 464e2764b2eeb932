// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/triangulation.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace handeye {
namespace {

constexpr int kMaxIterations = 6;

/// The point with the least squared distance to all rays.
std::optional<Eigen::Vector3d> midpoint(std::span<const PosedRay> rays) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const PosedRay& seen : rays) {
    const Pose& pose = *seen.eye_from_scene;
    const Eigen::Vector3d direction =
        pose.linear().transpose() * seen.ray.homogeneous().normalized();
    const Eigen::Vector3d centre = -(pose.linear().transpose() * pose.translation());
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - direction * direction.transpose();
    normal += across;
    right += across * centre;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(normal);
  if (!(eigen.eigenvalues()(0) > 1e-9 * eigen.eigenvalues()(2))) return std::nullopt;
  return normal.ldlt().solve(right);
}

}  // namespace

std::optional<Eigen::Vector3d> triangulate(std::span<const PosedRay> rays) {
  if (rays.size() < 2) return std::nullopt;
  auto point = midpoint(rays);
  if (!point) return std::nullopt;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    for (const PosedRay& seen : rays) {
      const Eigen::Vector3d point_eye = *seen.eye_from_scene * *point;
      if (!(point_eye.z() > 0)) return std::nullopt;
      const double inverse_z = 1.0 / point_eye.z();
      const Eigen::Vector2d normalised = point_eye.head<2>() * inverse_z;
      Eigen::Matrix<double, 2, 3> by_eye;
      by_eye << inverse_z, 0, -normalised.x() * inverse_z, 0, inverse_z,
          -normalised.y() * inverse_z;
      const Eigen::Matrix<double, 2, 3> by_scene = by_eye * seen.eye_from_scene->linear();
      normal += by_scene.transpose() * by_scene;
      gradient += by_scene.transpose() * (normalised - seen.ray);
    }
    const Eigen::Vector3d step = normal.ldlt().solve(gradient);
    if (!step.allFinite()) return std::nullopt;
    *point -= step;
    if (step.squaredNorm() < 1e-16 * point->squaredNorm()) break;
  }
  for (const PosedRay& seen : rays) {
    if (!((*seen.eye_from_scene * *point).z() > 0)) return std::nullopt;
  }
  return point;
}

double triangulation_angle_rad(std::span<const PosedRay> rays, const Eigen::Vector3d& point_scene) {
  if (rays.size() < 2) return 0.0;
  const auto direction = [&](const PosedRay& seen) -> Eigen::Vector3d {
    const Pose& pose = *seen.eye_from_scene;
    return (point_scene + pose.linear().transpose() * pose.translation()).normalized();
  };
  const Eigen::Vector3d first = direction(rays.front());
  const Eigen::Vector3d last = direction(rays.back());
  double largest = 0.0;
  for (const PosedRay& seen : rays) {
    const Eigen::Vector3d towards = direction(seen);
    largest = std::max({largest, std::atan2(towards.cross(first).norm(), towards.dot(first)),
                        std::atan2(towards.cross(last).norm(), towards.dot(last))});
  }
  return largest;
}

}  // namespace handeye
