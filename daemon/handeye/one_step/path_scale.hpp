// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/handeye/one_step/metric_problem.hpp"

namespace handeye {

/// How sure a solved problem is of the length of the camera's path: the variance of its logarithm,
/// g^T H^-1 g with g the derivative of log(spread) by the keyframes' centres, spread the root of
/// the sum of their squared distances from their mean. Of the part that knows it best: through
/// hand_from_eye it serves the others. Infinite where no path has a length.
double log_scale_variance(const MetricProblem& problem);

}  // namespace handeye
