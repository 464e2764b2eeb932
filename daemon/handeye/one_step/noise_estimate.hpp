// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "daemon/handeye/one_step/metric_problem.hpp"

namespace handeye {

/// How much of the tracker's own errors the solution has taken up: of each hand row the diagonal
/// of J H^-1 J^T (leverage), and more of errors that frames share. That part of the residual's
/// variance is missing. Estimated by some random probes (Hutchinson 1990), always the same: the
/// sums over all rows are what is used.
struct Leverage {
  std::vector<Vector6d> variances;  ///< of each hand row, not whitened [rad^2, mm^2]
  double whitened{0};               ///< sum over all rows: degrees of freedom used up
};
Leverage hand_leverage(const MetricProblem& problem);

/// Of the images at a minimum, per axis: as given, or from the residuals, however small. The
/// problem's own is never less than features err by together.
double image_noise_seen_px(const MetricProblem& problem);

/// Noise by medians where the problem starts: a start for `estimated_noise` that outliers do not
/// spoil. What is given stays.
MetricNoise noise_at_start(const MetricScene& scene, const OneStepOptions& options);

/// Noise from the residuals at a minimum (variance components: each sum of squares against what is
/// expected of it, with the degrees of freedom that the solution has used up). What is given stays.
MetricNoise estimated_noise(const MetricProblem& problem);

/// Degrees of freedom of the images' errors.
double image_freedom(const MetricProblem& problem);

}  // namespace handeye
