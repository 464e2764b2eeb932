// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "daemon/handeye/types.hpp"

namespace handeye {

/// Weights of the movements' translation equations for methods that find rotation and translation
/// at once, whose rotation equations weigh 1. As published such methods add squares of lengths to
/// squares of rotations, so that their result depends on the unit of length. Here the residuals at
/// a first solution say how well translations are known against rotations; and since a rotation's
/// noise acts on a movement's translation with that translation as its lever, long movements count
/// for less (the first-order noise of hand_j_from_hand_i with equal noise on every pose).
///
/// Translations of both sides in one unit, about 1; in the same unit the first solution,
/// eye_from_hand. The weights are between 1/30 and 30; on exact data they are 1.
std::vector<double> translation_weights(std::span<const Movement> movements,
                                        const Pose& eye_from_hand);

}  // namespace handeye
