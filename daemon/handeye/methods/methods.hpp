// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "daemon/handeye/types.hpp"

/// The methods of the table (math.md section 4), each a Solver. All are exact on exact data and
/// give nothing where the data do not determine the answer; those with unknown scale are
/// indifferent to the unit of the scene.
namespace handeye {

// Unknown scale.

/// Rotation from eq 4, scale from eq 6, then rotation and translation again by Daniilidis' linear
/// dual quaternions on the scaled eye (seed 1, section 4.1).
std::optional<HandEyeSolution> dq_scale_separate(const HandEyeProblem& problem);

/// All unknowns, scale among them, as one homogeneous linear system (Andreff, Horaud, Espiau 2001).
std::optional<HandEyeSolution> andreff(const HandEyeProblem& problem);

// Both.

/// Over poses, weighted by their noise (math.md section 4): the answer.
std::optional<HandEyeSolution> maximum_likelihood_unknown_scale(const HandEyeProblem& problem);

}  // namespace handeye
