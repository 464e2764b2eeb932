// SPDX-License-Identifier: BSD-3-Clause
#include "tests/sequences/pose_error.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

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

/// The rotation that takes the estimated orientations to the true ones, in the mean.
Eigen::Matrix3d mean_turn(std::span<const PosePair> pairs) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const PosePair& pair : pairs) {
    sum += pair.true_scene_from_eye.linear() * pair.estimated_scene_from_eye.linear().transpose();
  }
  return nearest_rotation(sum);
}

/// Root mean square and largest angle between true and turned estimated orientations [deg].
std::pair<double, double> rotation_errors_deg(std::span<const PosePair> pairs,
                                              const Eigen::Matrix3d& turn) {
  double squares = 0;
  double worst = 0;
  for (const PosePair& pair : pairs) {
    const double angle_deg = deg_from_rad(rotation_angle_rad(
        pair.true_scene_from_eye.linear(), turn * pair.estimated_scene_from_eye.linear()));
    squares += angle_deg * angle_deg;
    worst = std::max(worst, angle_deg);
  }
  return {std::sqrt(squares / static_cast<double>(pairs.size())), worst};
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

  std::tie(error.rotation_rms_deg, error.rotation_worst_deg) = rotation_errors_deg(pairs, rotation);
  std::tie(error.turning_rms_deg, error.turning_worst_deg) =
      rotation_errors_deg(pairs, mean_turn(pairs));
  double squares = 0;
  for (const PosePair& pair : pairs) {
    const Eigen::Vector3d aligned = scaled_rotation * pair.estimated_scene_from_eye.translation() +
                                    similarity.topRightCorner<3, 1>();
    const double distance =
        (aligned - pair.true_scene_from_eye.translation()).norm() / scene_distance_mm;
    squares += distance * distance;
    error.position_worst = std::max(error.position_worst, distance);
  }
  error.position_rms = std::sqrt(squares / static_cast<double>(pairs.size()));
  return error;
}

}  // namespace handeye::sequences
