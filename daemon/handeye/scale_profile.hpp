// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/handeye/pose_problem.hpp"

namespace handeye {

/// How far from the log scale of a part, of some distances tried either way, the data do not
/// reject the scale: 0 when they reject them all. Where hand and eye all but turn about one point,
/// the likelihood wanders along the scale by more than chance in the noise of the latent poses
/// seems to allow, and its curvature anywhere says nothing about the rest; but its gradient with
/// the other unknowns solved for has mean zero at the true scale and a variance that is known
/// (score test; ours, docs/math.md section 10). `noise`: at the solution; `inflation` of the
/// variance for correlated errors.
double undecided_log_scale(const PoseProblem& solved, std::size_t part,
                           const MaximumLikelihoodOptions& options, const PartNoise& noise,
                           double inflation);

}  // namespace handeye
