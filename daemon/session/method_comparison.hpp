// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "daemon/handeye/types.hpp"
#include "daemon/session/result.hpp"

namespace handeye {

/// One method's answer to a problem, with its residuals over all of the problem's poses and its
/// time, which is that of the method alone.
MethodResult run_method(const Method& method, const HandEyeProblem& problem);

/// Each method's answer to the same poses, with residuals and time.
std::vector<MethodResult> compare_methods(std::span<const Method> methods,
                                          std::span<const PosePair> poses, const PoseNoise& noise,
                                          ScaleMode scale = ScaleMode::kUnknown);

}  // namespace handeye
