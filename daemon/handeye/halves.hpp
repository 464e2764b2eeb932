// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "daemon/handeye/maximum_likelihood.hpp"

namespace handeye {

/// The answers of two disjoint halves of the data.
struct HalvesComparison {
  Vector6d difference;  ///< (w [rad], dt [mm]) from the second half's answer to the first's
  double chi2{0};       ///< its squared Mahalanobis distance: 6 degrees of freedom
};

/// Solves the first and the second half of each part where the observations are in order of time,
/// which sets apart what slipped half-way; else every other pose. Parts that `result`, of the same
/// observations, has left out are in neither. Nothing when a half does not determine an answer.
std::optional<HalvesComparison> compare_halves(std::span<const HandEyeObservation> observations,
                                               const MaximumLikelihoodResult& result,
                                               const MaximumLikelihoodOptions& solver);

}  // namespace handeye
