// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "daemon/handeye/types.hpp"

namespace handeye {

/// Where `maximum_likelihood` may start from: what the linear methods find on a selection of
/// movements, and, should they all fail on a poorly observable scale, the ratio of the path lengths
/// with the translation that fits it best. Empty when not even the rotation is determined.
std::vector<HandEyeSolution> starting_solutions(std::span<const PosePair> poses);

}  // namespace handeye
