// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "daemon/handeye/types.hpp"

namespace handeye {

/// Covariance of (w [rad], dt [mm]) of hand_from_eye, R = Exp(w) R_estimate and
/// t = t_estimate + dt, of a method that solves from movements: the noise of every pose carried, to
/// first order, through all movements that share it (docs/math.md section 4). A method solves, in
/// one or more stages, sum_k J_k^T r_k = 0; with r_k = J_k x + sum_i P_ki n_i over the poses i of
/// movement k it follows that x = -A^-1 sum_i G_i n_i with A = sum_k J_k^T J_k and G_i = sum_k
/// J_k^T P_ki, and its covariance is A^-1 (sum_i G_i Cov(n_i) G_i^T) A^-T. The noise is taken as
/// independent between poses. `pairs`: the movements' poses i, j (Selection::pairs). Nothing for
/// methods that solve from poses, and where the movements do not determine an answer.
std::optional<Matrix6d> sandwich_covariance(const Method& method, std::span<const PosePair> poses,
                                            std::span<const std::array<std::size_t, 2>> pairs,
                                            const HandEyeSolution& solution,
                                            const PoseNoise& noise);

}  // namespace handeye
