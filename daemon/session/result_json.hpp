// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include "daemon/session/result.hpp"

namespace handeye {

/// The documented result JSON (docs/result.md). Numbers that do not exist are null, never NaN.
nlohmann::ordered_json to_json(const CalibrationResult& result);

}  // namespace handeye
