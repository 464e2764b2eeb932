// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "daemon/geometry/pose.hpp"
#include "daemon/handeye/perspective/perspective_matrix.hpp"

/// Hand-eye from perspective matrices, with no decomposition into intrinsics and poses (Horaud and
/// Dornaika 1995, second formulation): the camera is fixed to the hand, so M_i Y A_i = M_1 Y.
namespace handeye {

/// One position: its matrix and A = hand1_from_hand [mm]. The first position of a set is hand1.
struct MatrixPosition {
  PerspectiveMatrix matrix;
  Pose hand1_from_hand{Pose::Identity()};
};

/// Y = object_from_hand1 [mm] in closed form. Nothing when the hand's rotations do not determine
/// it (fewer than three positions, parallel axes) or the matrices are singular.
std::optional<Pose> closed_form_object_from_hand(std::span<const MatrixPosition> positions);

/// One undamped Gauss-Newton step of  sum_i |M_i Y A_i - M_1 Y|^2  over the Gibbs vector and the
/// translation of Y. Nothing when the normal equations are singular or the step is not finite.
std::optional<Pose> gauss_newton_step(std::span<const MatrixPosition> positions,
                                      const Pose& object_from_hand);

/// Relative size of a step: rotation angle [rad], or change of the translation by its norm.
double step_size(const Pose& from, const Pose& to);

struct MatrixMethodResult {
  Pose object_from_hand{Pose::Identity()};  ///< Y, mm
  int iterations{0};                        ///< Gauss-Newton steps
};

/// Gauss-Newton from `start` until a step is below 1e-8. Nothing when it does not converge.
std::optional<MatrixMethodResult> matrix_method(std::span<const MatrixPosition> positions,
                                                const Pose& start);

}  // namespace handeye
