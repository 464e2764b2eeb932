// SPDX-License-Identifier: BSD-3-Clause
#include "tests/sequences/pose_error.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace handeye::sequences {
namespace {

/// Spread of positions along their second direction, relative to the first, below which they lie on
/// a line.
constexpr double kFlatness = 1e-6;

/// Eye positions, a column a pair.
Eigen::Matrix3Xd positions(std::span<const PosePair> pairs, Pose PosePair::*which) {
  Eigen::Matrix3Xd columns(3, static_cast<Eigen::Index>(pairs.size()));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    columns.col(static_cast<Eigen::Index>(i)) = (pairs[i].*which).translation();
  }
  return columns;
}

bool on_a_line(const Eigen::Matrix3Xd& points) {
  const Eigen::Matrix3Xd centred = points.colwise() - points.rowwise().mean();
  const Eigen::Vector3d spread =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(centred * centred.transpose()).eigenvalues();
  return !(spread[1] > kFlatness * kFlatness * spread[2]);
}

}  // namespace

std::optional<PoseError> pose_error(std::span<const PosePair> pairs, double scene_distance_mm) {
  if (pairs.size() < 3) return std::nullopt;
  const Eigen::Matrix3Xd truth = positions(pairs, &PosePair::true_scene_from_eye);
  const Eigen::Matrix3Xd estimate = positions(pairs, &PosePair::estimated_scene_from_eye);
  if (on_a_line(truth) || on_a_line(estimate)) return std::nullopt;

  const Eigen::Matrix4d similarity = Eigen::umeyama(estimate, truth, true);
  const Eigen::Matrix3d scaled_rotation = similarity.topLeftCorner<3, 3>();
  PoseError error;
  error.mm_per_unit = std::cbrt(scaled_rotation.determinant());
  const Eigen::Matrix3d rotation = scaled_rotation / error.mm_per_unit;

  double rotation_squares = 0;
  double position_squares = 0;
  for (const PosePair& pair : pairs) {
    const double angle_deg = deg_from_rad(rotation_angle_rad(
        pair.true_scene_from_eye.linear(), rotation * pair.estimated_scene_from_eye.linear()));
    const Eigen::Vector3d aligned = scaled_rotation * pair.estimated_scene_from_eye.translation() +
                                    similarity.topRightCorner<3, 1>();
    const double distance =
        (aligned - pair.true_scene_from_eye.translation()).norm() / scene_distance_mm;
    rotation_squares += angle_deg * angle_deg;
    position_squares += distance * distance;
    error.rotation_worst_deg = std::max(error.rotation_worst_deg, angle_deg);
    error.position_worst = std::max(error.position_worst, distance);
  }
  const auto count = static_cast<double>(pairs.size());
  error.rotation_rms_deg = std::sqrt(rotation_squares / count);
  error.position_rms = std::sqrt(position_squares / count);
  return error;
}

}  // namespace handeye::sequences
