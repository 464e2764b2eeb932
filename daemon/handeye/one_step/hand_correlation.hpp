// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/handeye/one_step/metric_problem.hpp"

namespace handeye {

/// Whether a sample has a share in both; the frames after one that does not share none, either.
bool share_samples(const HandAtFrame& earlier, const HandAtFrame& later);

/// The covariance of two frames' tracker errors for a variance of one sample of 1, by the shares
/// that both have in the same samples (docs/math.md section 8).
double shared_variance(const HandAtFrame& first, const HandAtFrame& second);

/// Likewise of their whitened residuals, rows of the problem; 6x6. Zero where they share nothing.
Matrix6d shared_covariance(const MetricProblem& problem, const HandRow& first,
                           const HandRow& second);

/// By how much errors of tracker and eye that are correlated in time widen the variance of what is
/// constant in time: the integrated autocorrelation of the whitened residuals, summed while it is
/// above what chance and shared samples explain.
double correlation_beyond_samples(const MetricProblem& problem);

}  // namespace handeye
