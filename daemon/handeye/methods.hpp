// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "daemon/handeye/types.hpp"

/// The methods of the table (math.md section 4), each a MovementSolver. All are exact on exact
/// data, indifferent to the unit of the scene, and give nothing where the data do not determine the
/// answer.
namespace handeye {

/// Rotation from eq 4, scale from eq 6, then rotation and translation again by Daniilidis' linear
/// dual quaternions on the scaled eye (seed 1, section 4.1).
std::optional<HandEyeSolution> dq_scale_separate(std::span<const Movement> movements);

/// All unknowns, scale among them, as one homogeneous linear system (Andreff, Horaud, Espiau 2001).
std::optional<HandEyeSolution> andreff(std::span<const Movement> movements);

}  // namespace handeye
