// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "daemon/handeye/types.hpp"

namespace handeye {

/// Where `maximum_likelihood` may start from: what linear methods find from the movements, and,
/// with unknown scale, in case they are led astray by a poorly observable one, several scales about
/// the ratio of the path lengths, each with the translation that fits it best. Empty when not even
/// the rotation is determined. With known scale every start's scale is 1.
std::vector<HandEyeSolution> starting_solutions(std::span<const Movement> movements,
                                                ScaleMode scale);

}  // namespace handeye
