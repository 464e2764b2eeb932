// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/handeye/one_step/metric_problem.hpp"

namespace handeye {

/// Minimises, estimates the noise, leaves out the tracker's outliers, and again until that changes
/// nothing, at most noise_rounds times; in the end the problem is linearised where it stands. False
/// where the equations determine nothing, or the lens runs away.
bool minimise_with_noise(MetricProblem& problem);

}  // namespace handeye
