// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "daemon/handeye/maximum_likelihood.hpp"

namespace handeye {

/// Selected movements between poses of the same part, never of two; with unknown scale the eye's
/// translations of all are in the unit of the largest part's scene, as well as a linear estimate of
/// the parts' scales brings them there. For starts: together the parts may turn about two axes
/// where none does alone.
std::vector<Movement> movements_within_parts(std::span<const HandEyeObservation> observations,
                                             ScaleMode scale);

}  // namespace handeye
