// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "daemon/handeye/pose_problem.hpp"

namespace handeye {

/// Covariance of the unknowns at the minimum of `problem`: H^-1 G H^-1, G the information of
/// Gauss-Newton (the variance of the gradient), H the true Hessian. The two differ where the noise
/// of the eye's path is mistaken for movement: near a fixed point G claims a scale that H knows
/// nothing of (docs/math.md section 10). The eye's share in the translation noise, which no
/// residual shows, is one more source of error. Finite and huge along what the data do not
/// determine.
PartedMatrix covariance_of_unknowns(const PoseProblem& problem, const PartNoise& noise,
                                    bool noise_estimated);

/// Standard deviation of the eye's share in the translation noise.
double share_sigma(bool noise_estimated);

/// How the gradient at the problem's unknowns changes with that share, the same in all parts.
PartedVector gradient_by_share(const PoseProblem& problem, PartNoise noise);

/// Widens the covariance to at least this standard deviation of the log scale that stands at
/// `scale`, and with it what that scale explains of the others.
void widen_scale(PartedMatrix& covariance, Eigen::Index scale, double log_scale_sigma);

/// How many times fewer independent poses there are than poses in order of time: the integrated
/// autocorrelation of the whitened residuals, summed while it is above what chance shows. The
/// unknowns act slowly compared with it, so that the whole of it counts. Each part's residuals are
/// a series of their own, of one correlation.
double correlation_time(const std::vector<std::vector<Vector6d>>& whitened_of_parts);

}  // namespace handeye
