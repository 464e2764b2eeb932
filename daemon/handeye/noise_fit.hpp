// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "daemon/handeye/noise_model.hpp"

namespace handeye {

/// Variance components: the noise that explains the residuals of one pose each (not whitened), as
/// far as they are not outliers (Huber's proposal 2, `huber` the norm beyond which a whitened
/// residual counts no more), by Fisher scoring from `start`. `assumed` weighs as much as one
/// pose; the residuals are fewer by what `parameters` unknowns have absorbed.
ResidualNoise::Variances fit_noise(const std::vector<Vector6d>& residuals,
                                   const ResidualNoise& noise, double parameters, double huber,
                                   const ResidualNoise::Variances& assumed,
                                   const ResidualNoise::Variances& start);

}  // namespace handeye
