// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "daemon/handeye/pose_problem.hpp"

namespace handeye {

/// A problem needs at least so many poses: two movements.
inline constexpr std::size_t kFewestLikelihoodPoses = 3;

/// Unknowns and noise in turn, and the poses that count. Huber's loss bounds an outlier's pull but
/// keeps it; many that pull the same way would still bias the answer. So what the noise cannot
/// explain is left out, and the rest solved again, part by part. Returns the noise that was last
/// fitted.
PartNoise solve_without_outliers(PoseProblem& problem, const MaximumLikelihoodOptions& options);

/// Unknowns and noise in turn, of the poses that count.
PartNoise solve(PoseProblem& problem, const MaximumLikelihoodOptions& options);

/// With the assumed noise from every start: the one that fits most poses best, whatever the others
/// do. One scale a part for the eye's noise, that of the first start, makes them comparable.
/// Nothing when no start is usable.
std::optional<HandEyeSolution> best_start(std::span<const HandEyeObservation> observations,
                                          const std::vector<HandEyeSolution>& starts,
                                          const MaximumLikelihoodOptions& options);

}  // namespace handeye
