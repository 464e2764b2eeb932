// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include "daemon/session/result.hpp"

namespace handeye {

/// The inverse of to_json() (result_json.hpp), for every kind of result. Figures that were null are
/// NaN again; what an answer rests on must be there and make sense: pose, covariance, sigmas,
/// camera. Throws InputError that says what is missing or wrong.
CalibrationResult result_from_json(const nlohmann::ordered_json& json);

}  // namespace handeye
