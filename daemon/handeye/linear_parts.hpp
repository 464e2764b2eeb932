// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "daemon/handeye/types.hpp"

/// The linear steps that several methods share (seed 1, section 4; docs/math.md sections 1 and 2).
/// None forms normal equations for its result: those would square the condition and lose half the
/// digits.
namespace handeye {

/// Left and right multiplication as matrices on (w, x, y, z): p q = left(p) q = right(q) p.
Eigen::Matrix4d left_product(const Eigen::Quaterniond& q);
Eigen::Matrix4d right_product(const Eigen::Quaterniond& q);

/// R_E R_X - R_X R_H as a matrix on the nine entries of R_X, row by row.
Eigen::Matrix<double, 9, 9> entry_rows(const Movement& movement);

/// Right singular vectors and singular values (descending) of a tall matrix, by way of QR: as exact
/// as the full decomposition, at a fraction of its cost.
struct RightSingular {
  Eigen::MatrixXd vectors;
  Eigen::VectorXd values;
};
RightSingular right_singular(const Eigen::MatrixXd& tall);

/// Least squares by QR with the columns scaled to one length. Nothing when there are fewer
/// rows than columns, a column is zero or the columns are dependent.
std::optional<Eigen::VectorXd> least_squares(const Eigen::MatrixXd& matrix,
                                             const Eigen::VectorXd& right);

/// R_X of R_X R_H = R_E R_X (eq 4), least squares in unit quaternions. The sign of each pair of
/// quaternions, ambiguous near 180 degrees, is the one that agrees with the rotation found. Nothing
/// when all axes are parallel or there are fewer than two movements.
std::optional<Eigen::Matrix3d> eye_from_hand_rotation(std::span<const Movement> movements);

/// The same direction or turn in both frames: eye = R_X hand.
struct VectorPair {
  Eigen::Vector3d hand{Eigen::Vector3d::Zero()};
  Eigen::Vector3d eye{Eigen::Vector3d::Zero()};
};

/// The rotation R that minimises sum |eye - R hand|^2, as the unit quaternion q of
/// sum |Q(eye) q - q Q(hand)|^2. Nothing when all vectors are parallel or fewer than two.
std::optional<Eigen::Matrix3d> rotation_between(std::span<const VectorPair> pairs);

struct ScaleAndTranslation {
  Eigen::Vector3d translation_scene{Eigen::Vector3d::Zero()};  ///< t_X in scene units
  double scale_units_per_mm{1};
};

/// t_X and s of [ I - R_E | R_X t_H ] (t_X; s) = t_E (eq 6), least squares. Nothing when the
/// columns are dependent or s is not positive.
std::optional<ScaleAndTranslation> scale_and_translation(std::span<const Movement> movements,
                                                         const Eigen::Matrix3d& eye_from_hand);

/// t_X of (I - R_E) t_X = t_E - R_X t_H (eq 3), least squares; both sides in one unit.
std::optional<Eigen::Vector3d> translation_of(std::span<const Movement> movements,
                                              const Eigen::Matrix3d& eye_from_hand);

/// R_X, or nothing where the movements do not determine it.
using RotationSolver = std::optional<Eigen::Matrix3d> (*)(std::span<const Movement> movements);

/// What most methods with known scale do: the rotation in their own way, then `translation_of`.
std::optional<HandEyeSolution> rotation_then_translation(const HandEyeProblem& problem,
                                                         RotationSolver rotation_solver);

}  // namespace handeye
