// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <handeye/method_result_t.hpp>

#include "daemon/session/result.hpp"

namespace handeye {

/// What one method found, as it travels within RESULT, and back. What cannot be represented (no
/// solution, no sigma) uses the conventions of method_result_t.lcm.
method_result_t method_message(const MethodResult& method);
MethodResult method_from_message(const method_result_t& message);

}  // namespace handeye
