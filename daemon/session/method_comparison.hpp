// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "daemon/handeye/types.hpp"
#include "daemon/session/result.hpp"

namespace handeye {

/// Each method's answer to the same poses, with residuals and time.
std::vector<MethodResult> compare_methods(std::span<const Method> methods,
                                          std::span<const PosePair> poses, const PoseNoise& noise);

}  // namespace handeye
