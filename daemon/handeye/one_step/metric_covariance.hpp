// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/handeye/one_step/metric_problem.hpp"

namespace handeye {

/// How sure the common unknowns are.
struct MetricCovariance {
  CommonMatrix covariance{CommonMatrix::Zero()};  ///< 0 for what is held
  double log_scale_sigma{0};                      ///< see OneStepResult
  double correlation_inflation{1};  ///< of the tracker's part, for errors correlated in time
};

/// From the normal equations of a solved problem, points and poses eliminated, and made honest
/// where errors are not independent (a sandwich, White 1982): frames that share samples of the
/// tracker, by what they share; errors correlated in time; noise that was given and is exceeded;
/// and errors along a feature's track, by the spread of whole tracks' gradients in directions in
/// which that is larger (clusters: Liang & Zeger 1986). `hand_freedom`: degrees of freedom of the
/// tracker's residuals.
MetricCovariance metric_covariance(const MetricProblem& problem, double hand_freedom);

}  // namespace handeye
