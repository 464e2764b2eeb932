// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/handeye/one_step/one_step.hpp"

namespace handeye {

/// Numbers are numbers, a hand's shares add up to it, and what refers to frames refers to
/// keyframes of the same part, in order.
bool is_sound(const OneStepProblem& problem);

}  // namespace handeye
