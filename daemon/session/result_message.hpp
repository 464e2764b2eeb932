// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <handeye/result_t.hpp>

#include "daemon/session/result.hpp"

namespace handeye {

/// The result as it travels on RESULT, and back. What cannot be represented (no time offset) uses
/// the conventions of result_t.lcm.
result_t to_message(const CalibrationResult& result);
CalibrationResult from_message(const result_t& message);

}  // namespace handeye
