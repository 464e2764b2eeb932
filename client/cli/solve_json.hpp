// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include "daemon/session/pose_solve.hpp"

namespace handeye::cli {

/// The result JSON of poses alone (docs/result.md): as every result's, null where a field speaks
/// of devices or images, and with `scale`, `poses` and `noise`.
nlohmann::ordered_json solve_json(const PoseSolution& solution);

}  // namespace handeye::cli
