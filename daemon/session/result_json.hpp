// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include "daemon/session/result.hpp"

namespace handeye {

/// The documented result JSON (docs/result.md). Numbers that do not exist are null, never NaN.
nlohmann::ordered_json to_json(const CalibrationResult& result);

/// {"q_wxyz": [w, x, y, z], "t_mm": [x, y, z]}; w is never negative.
nlohmann::ordered_json pose_json(const Pose& pose);

}  // namespace handeye
