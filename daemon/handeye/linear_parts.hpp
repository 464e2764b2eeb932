// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "daemon/handeye/types.hpp"

/// The linear steps that several methods share (seed 1, section 4; math.md section 2).
namespace handeye {

/// Left and right multiplication as matrices on (w, x, y, z): p q = left(p) q = right(q) p.
Eigen::Matrix4d left_product(const Eigen::Quaterniond& q);
Eigen::Matrix4d right_product(const Eigen::Quaterniond& q);

/// Right singular vectors and singular values (descending) of a tall matrix, by way of QR: as exact
/// as the full decomposition, at a fraction of its cost.
struct RightSingular {
  Eigen::MatrixXd vectors;
  Eigen::VectorXd values;
};
RightSingular right_singular(const Eigen::MatrixXd& tall);

/// R_X of R_X R_H = R_E R_X (eq 4), least squares in unit quaternions. The sign of each pair of
/// quaternions, ambiguous near 180 degrees, is taken from the linear solution for the nine entries.
std::optional<Eigen::Matrix3d> eye_from_hand_rotation(std::span<const Movement> movements);

struct ScaleAndTranslation {
  Eigen::Vector3d translation_scene{Eigen::Vector3d::Zero()};  ///< t_X in scene units
  double scale_units_per_mm{1};
};

/// t_X and s of [ I - R_E | R_X t_H ] (t_X; s) = t_E (eq 6), least squares. Nothing when the
/// columns are dependent or s is not positive.
std::optional<ScaleAndTranslation> scale_and_translation(std::span<const Movement> movements,
                                                         const Eigen::Matrix3d& eye_from_hand);

}  // namespace handeye
