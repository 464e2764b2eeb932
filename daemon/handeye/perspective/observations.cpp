// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/perspective/observations.hpp"

#include <algorithm>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "daemon/handeye/perspective/perspective_matrix.hpp"

namespace handeye {
namespace {

constexpr std::size_t kMinPositions = 3;
constexpr std::size_t kMinPlanarPoints = 4;  // a homography
constexpr double kMinRotation_rad = 1e-3;    // about a second axis; less is no rotation

std::vector<Eigen::Vector3d> object_points(const ObservedPosition& position) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(position.points.size());
  for (const ObjectPoint& point : position.points) points.push_back(point.object_mm);
  return points;
}

/// Rotation about the best and the second best axis, rms over the positions [rad].
Eigen::Vector2d spread_of_rotations(const Observations& observations) {
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const ObservedPosition& position : observations.positions) {
    const Eigen::Vector3d w = log_so3(position.hand1_from_hand.linear());
    scatter += w * w.transpose();
  }
  scatter /= static_cast<double>(observations.positions.size());
  const Eigen::Vector3d squares =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvalues();
  return {std::sqrt(std::max(0.0, squares(2))), std::sqrt(std::max(0.0, squares(1)))};
}

/// Points of a plane that do not lie on a line.
bool spans_plane(const std::vector<Eigen::Vector3d>& points) {
  Eigen::MatrixXd centred(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    centred.col(static_cast<Eigen::Index>(i)) = points[i];
  }
  centred.colwise() -= centred.rowwise().mean().eval();
  const Eigen::VectorXd s = Eigen::BDCSVD<Eigen::MatrixXd>(centred).singularValues();
  constexpr double kThin = 1e-3;
  return s(1) > kThin * s(0);
}

constexpr double kLargest = 1e9;  // mm or px; beyond it nothing is observed

template <typename Vector>
bool sensible(const Vector& numbers) {
  return numbers.allFinite() && numbers.cwiseAbs().maxCoeff() <= kLargest;
}

/// The first position whose numbers cannot be used.
std::optional<PerspectiveRefusal> unusable_numbers(const Observations& observations) {
  for (std::size_t i = 0; i < observations.positions.size(); ++i) {
    const ObservedPosition& position = observations.positions[i];
    const Eigen::Matrix3d r = position.hand1_from_hand.linear();
    constexpr double kRigid = 1e-6;
    bool usable = position.hand1_from_hand.matrix().allFinite() &&
                  (r.transpose() * r - Eigen::Matrix3d::Identity()).norm() < kRigid &&
                  r.determinant() > 0.0 && sensible(position.hand1_from_hand.translation());
    for (const ObjectPoint& point : position.points) {
      usable = usable && sensible(point.object_mm) && sensible(point.pixel);
    }
    if (!usable) {
      return PerspectiveRefusal{
          "unusable_numbers",
          fmt::format("position {} holds numbers that are not finite, beyond {:g}, or no rotation",
                      i + 1, kLargest)};
    }
  }
  return std::nullopt;
}

std::optional<PerspectiveRefusal> lacking_points(const Observations& observations) {
  const bool planar = observations.planar();
  const std::size_t wanted = planar ? kMinPlanarPoints : kMinPointsForMatrix;
  for (std::size_t i = 0; i < observations.positions.size(); ++i) {
    const auto points = object_points(observations.positions[i]);
    if (points.size() < wanted || !spans_plane(points)) {
      return PerspectiveRefusal{
          "too_few_points",
          fmt::format("position {} has {} points; at least {} that do not lie on a line are needed",
                      i + 1, points.size(), wanted)};
    }
    if (!planar && coplanar(points)) {
      return PerspectiveRefusal{
          "too_few_points",
          fmt::format("the points of position {} lie in one plane, those of others do not: observe "
                      "points out of the plane there too, or one plane in all positions",
                      i + 1)};
    }
  }
  return std::nullopt;
}

}  // namespace

std::size_t Observations::point_count() const {
  std::size_t count = 0;
  for (const ObservedPosition& position : positions) count += position.points.size();
  return count;
}

bool Observations::planar() const {
  std::vector<Eigen::Vector3d> all;
  all.reserve(point_count());
  for (const ObservedPosition& position : positions) {
    for (const ObjectPoint& point : position.points) all.push_back(point.object_mm);
  }
  return coplanar(all);
}

std::optional<PerspectiveRefusal> lacking(const Observations& observations) {
  if (observations.positions.size() < kMinPositions) {
    return PerspectiveRefusal{"too_few_positions",
                              fmt::format("{} positions; at least {} are needed",
                                          observations.positions.size(), kMinPositions)};
  }
  if (auto numbers = unusable_numbers(observations)) return numbers;
  if (auto points = lacking_points(observations)) return points;
  const Eigen::Vector2d rotation = spread_of_rotations(observations);
  if (rotation(0) < kMinRotation_rad) {
    return PerspectiveRefusal{"insufficient_rotation",
                              "the hand only moves without turning: turn it about two axes"};
  }
  if (rotation(1) < kMinRotation_rad) {
    return PerspectiveRefusal{
        "single_axis", "the hand turns about parallel axes only: turn it about a second one"};
  }
  return std::nullopt;
}

}  // namespace handeye
