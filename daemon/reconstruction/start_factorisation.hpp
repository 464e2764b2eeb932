// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "daemon/reconstruction/start_method.hpp"
#include "daemon/reconstruction/start_window.hpp"

namespace handeye {

/// Start by factorisation: the tracks that move as one rigid body, their paraperspective
/// factorisation taken on to perspective, once for each of the two mirrored scenes. Nothing where
/// the window is too small or its metric constraints have no positive definite solution.
/// `noise`: of a ray's coordinate, normalised.
std::vector<StartHypothesis> start_by_factorisation(const StartWindow& window, double noise);

}  // namespace handeye
