// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "daemon/handeye/perspective/one_step.hpp"
#include "daemon/handeye/perspective/refinement.hpp"

namespace handeye {

/// The refusal of observations that leave an unknown open.
PerspectiveRefusal not_determined();

/// Why a refined answer is not to be trusted: the hand would be wrong by more than a noisy one is,
/// or an angle, a length or the focal length is known no better than its own size. Nothing when it
/// can be.
std::optional<PerspectiveRefusal> doubtful(const Observations& observations,
                                           const Refinement& refinement);

}  // namespace handeye
