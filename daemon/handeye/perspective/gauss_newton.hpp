// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "daemon/handeye/perspective/lens.hpp"
#include "daemon/handeye/perspective/matrix_method.hpp"
#include "daemon/handeye/perspective/observations.hpp"

/// Chung's new method: the lens distortion inside the perspective matrices. Unknown are
/// k1, the image centre, every M_i, and Y = object_from_hand1, all found by one undamped
/// Gauss-Newton iteration.
namespace handeye {

/// Everything that is unknown.
struct PerspectiveState {
  SensorLens lens;                          ///< its pixel_mm is known
  std::vector<PerspectiveMatrix> matrices;  ///< M_i, one a position, in order
  Pose object_from_hand{Pose::Identity()};  ///< Y, mm
};

/// M_i and A_i side by side, for the matrix method.
std::vector<MatrixPosition> matrix_positions(const Observations& observations,
                                             std::span<const PerspectiveMatrix> matrices);

/// The matrices by DLT from the images as this lens undistorts them. Nothing where a position's
/// points do not determine one.
std::optional<std::vector<PerspectiveMatrix>> matrices_by_dlt(const Observations& observations,
                                                              const SensorLens& lens);

/// One undamped Gauss-Newton step: lens and matrices from
///   x_u(pixel; k1, centre) = M_i P   [mm on the undistorted sensor]
/// and, for each M_i, three soft equations of weight 1 beside those of its images: its third row
/// shall be of norm 1 and its first two normal to it (principal point at the image centre). They
/// are no constraint: where the images contradict them, they hold only nearly. Then the Gibbs
/// vector and p of Y from M_i Y A_i = M_1 Y. Nothing when a part of it is not determined.
std::optional<PerspectiveState> gauss_newton_step(const Observations& observations,
                                                  const PerspectiveState& state);

struct GaussNewtonResult {
  PerspectiveState state;
  int iterations{0};
  std::vector<PerspectiveState> history;  ///< start, then after every step
};

/// Steps until Y, k1 and the centre change by less than 1e-8 (relative, centre: of the image's
/// width). Nothing when it does not converge.
std::optional<GaussNewtonResult> gauss_newton(const Observations& observations,
                                              const PerspectiveState& start);

}  // namespace handeye
