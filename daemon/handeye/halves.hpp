// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "daemon/handeye/maximum_likelihood.hpp"
#include "daemon/handeye/one_step/one_step.hpp"

namespace handeye {

/// The answers of two disjoint halves of the data.
struct HalvesComparison {
  Vector6d difference;  ///< (w [rad], dt [mm]) from the second half's answer to the first's
  Matrix6d covariance;  ///< of it, as both halves claim
  double chi2{0};       ///< its squared Mahalanobis distance: 6 degrees of freedom
};

/// The halves of one whole: by the same estimator from the same data, for only compare_halves()
/// makes them.
struct HalvesOfWhole : HalvesComparison {
  Matrix6d of_whole;  ///< covariance of the whole's answer, as it claims

  /// What the difference means for the answer of the whole: the standard error of the mean of two
  /// that differ by d is d/2. It is less along directions that the whole knows better than its
  /// halves together do, for there d is mostly the halves' own. Of another estimator's answer,
  /// which may claim to know anything better, it would mean nothing.
  Vector6d error_of_whole() const;
};

/// Of two answers of their own, `covariance` that of their difference.
HalvesComparison compare(const Pose& first, const Pose& second, const Matrix6d& covariance);

/// Solves the first and the second half of each part where the observations are in order of time,
/// which sets apart what slipped half-way; else every other pose. Parts that `result`, of the same
/// observations, has left out are in neither. Nothing when a half does not determine an answer.
std::optional<HalvesOfWhole> compare_halves(std::span<const HandEyeObservation> observations,
                                            const MaximumLikelihoodResult& result,
                                            const MaximumLikelihoodOptions& solver);

/// The same by one_step, each half with its own frames, points and time offset; noise and lens are
/// those that the whole found. `start`, `options`: that led to `whole`. Two threads, and the same
/// answer every time.
std::optional<HalvesOfWhole> compare_halves(const OneStepProblem& problem,
                                            const MaximumLikelihoodResult& start,
                                            const OneStepResult& whole,
                                            const OneStepOptions& options);

}  // namespace handeye
