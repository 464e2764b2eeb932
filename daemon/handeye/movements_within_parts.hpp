// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "daemon/handeye/maximum_likelihood.hpp"

namespace handeye {

/// Movements of several parts, the eye's translations in the unit of one part's scene.
struct MovementsOfParts {
  std::vector<Movement> movements;
  std::size_t unit_part{0};  ///< whose unit that is: position in parts_of()
};

/// Selected movements between poses of the same part, never of two; with unknown scale the eye's
/// translations of all are in the unit of the largest part that turns, as well as a linear estimate
/// of the parts' scales brings them there. For starts: together the parts may turn about two axes
/// where none does alone.
MovementsOfParts movements_within_parts(std::span<const HandEyeObservation> observations,
                                        ScaleMode scale);

}  // namespace handeye
