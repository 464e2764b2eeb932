// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "daemon/handeye/types.hpp"

/// The methods of the table (docs/math.md section 4), each a Solver. All are exact on exact data;
/// those with unknown scale are indifferent to the unit of the scene. Those that solve from
/// movements give nothing where the data do not determine the answer. Maximum likelihood may give
/// one with the covariance it has, say with unknown scale about a fixed point: the judge refuses
/// it.
namespace handeye {

// Known scale: most find the rotation first, each in its own way, then the translation.

/// Linear in the Gibbs vector of R_X (Tsai, Lenz 1989).
std::optional<HandEyeSolution> tsai_lenz(const HandEyeProblem& problem);

/// Each movement leaves a turn about its axis; all must agree on the rest (Shiu, Ahmad 1989).
std::optional<HandEyeSolution> shiu_ahmad(const HandEyeProblem& problem);

/// Null vector of the quaternion equations (Chou, Kamel 1991).
std::optional<HandEyeSolution> chou_kamel(const HandEyeProblem& problem);

/// Lines of the screws laid on each other (Chen 1991).
std::optional<HandEyeSolution> chen(const HandEyeProblem& problem);

/// Rotation vectors laid on each other (Park, Martin 1994).
std::optional<HandEyeSolution> park_martin(const HandEyeProblem& problem);

/// Quaternion eigenproblem (Horaud, Dornaika 1995).
std::optional<HandEyeSolution> horaud_closed_form(const HandEyeProblem& problem);

/// Rotation and translation at once, by the non-linear function of Horaud and Dornaika 1995 as
/// printed: its weights add rad^2 to mm^2, so noisy translations cost it more than other methods.
std::optional<HandEyeSolution> horaud_nonlinear(const HandEyeProblem& problem);

/// Rotation and translation at once by linear dual quaternions (Daniilidis 1999).
std::optional<HandEyeSolution> daniilidis(const HandEyeProblem& problem);

/// Linear in the nine entries of R_X and in t_X; `andreff` of the known-scale table (Andreff,
/// Horaud, Espiau 1999).
std::optional<HandEyeSolution> andreff_known_scale(const HandEyeProblem& problem);

// Unknown scale.

/// Rotation from eq 4, scale from eq 6, then rotation and translation again by Daniilidis' linear
/// dual quaternions on the scaled eye (seed 1, section 4.1).
std::optional<HandEyeSolution> dq_scale_separate(const HandEyeProblem& problem);

/// Scale from eqs 4 and 6, then horaud_nonlinear on the scaled eye (seed 1, section 4.1).
std::optional<HandEyeSolution> horaud_scale_separate(const HandEyeProblem& problem);

/// The scale by eq 7, then rotation and translation again by the linear dual quaternions.
std::optional<HandEyeSolution> nonlinear_quaternion(const HandEyeProblem& problem);

/// The scale by eq 15, then rotation and translation again by the linear dual quaternions.
std::optional<HandEyeSolution> nonlinear_dual_quaternion(const HandEyeProblem& problem);

/// All unknowns, scale among them, as one homogeneous linear system (Andreff, Horaud, Espiau 2001).
std::optional<HandEyeSolution> andreff(const HandEyeProblem& problem);

// Both.

/// Over poses, weighted by their noise (docs/math.md section 4): the answer.
std::optional<HandEyeSolution> maximum_likelihood_known_scale(const HandEyeProblem& problem);
std::optional<HandEyeSolution> maximum_likelihood_unknown_scale(const HandEyeProblem& problem);

}  // namespace handeye
