// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "daemon/handeye/types.hpp"
#include "tests/unit/handeye/synthetic.hpp"

namespace handeye::synthetic {

/// The Cramer-Rao bound of (w [rad], dt [mm]) of hand_from_eye: what no unbiased estimator falls
/// below. The inverse Fisher information at the truth of the whole problem, in which the true hand
/// poses are unknown as well and both devices' measurements are observations of their own; by
/// numerical differentiation of the measurements, with nothing of the solver's equations.
struct CramerRaoBound {
  Matrix6d known_scale;
  Matrix6d unknown_scale;
};

/// `room_from_hand`: the true poses.
CramerRaoBound cramer_rao_bound(const Truth& truth, const std::vector<Pose>& room_from_hand,
                                const PoseNoise& noise);

}  // namespace handeye::synthetic
