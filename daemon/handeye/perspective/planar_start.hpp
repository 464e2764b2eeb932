// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "daemon/handeye/perspective/gauss_newton.hpp"

namespace handeye {

/// Lens and matrices of a planar object, whose images are homographies and determine no M alone:
/// Zhang's method finds the intrinsics from all positions together, and M_i = K [R_i t_i].
/// Y is left as it is. Nothing when the positions do not determine the intrinsics.
std::optional<PerspectiveState> planar_start(const Observations& observations,
                                             bool distortion_inside);

}  // namespace handeye
