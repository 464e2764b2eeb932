// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "daemon/reconstruction/scene.hpp"
#include "daemon/reconstruction/start_candidate.hpp"

namespace handeye {

/// Whether two scenes tell the same cameras and depths apart from scale: rotations within 0.02 rad,
/// centres, in units of the median depth, within a quarter of their extent. Scenes that share fewer
/// than three frames do not.
bool same_solution(const Scene& a, const Scene& b);

/// Position of the candidate with the smallest error, if it is at least 1.2 times smaller than that
/// of every candidate which is another solution; else nothing: the images cannot tell.
std::optional<std::size_t> choose_start(const std::vector<StartCandidate>& candidates);

}  // namespace handeye
