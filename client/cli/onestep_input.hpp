// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "daemon/handeye/perspective/one_step.hpp"

namespace handeye::cli {

/// Reads OBSERVATIONS.json (docs/onestep.md). Throws InputError for a file that is missing, no
/// JSON, or holds a number that cannot be used; the text names the place.
Observations read_observations(const std::filesystem::path& file);

/// Reads a start: object_from_hand {t_mm, and gibbs or q_wxyz}, camera {cx, cy, k1_per_mm2},
/// perspective_matrices (one a position, 3 x 4); each may be left out or null, but not all. A
/// result of onestep is one. Throws InputError likewise.
PerspectiveStart read_start(const std::filesystem::path& file, const Observations& observations);

}  // namespace handeye::cli
