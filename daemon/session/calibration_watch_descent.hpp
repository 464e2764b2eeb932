// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "daemon/session/calibration_watch_equations.hpp"

namespace handeye {

struct WatchDescent {
  int iterations{0};
  bool converged{false};
};

/// Levenberg-Marquardt on watch_cost, of at most so many iterations. Without a loss (see
/// freeze_trust) it goes over to Newton's steps near the end: how deep the scene is and where the
/// eyes are is one product, and with the hand's noise in it Gauss-Newton gets hardly on.
WatchDescent watch_descend(std::span<const WatchFrame> frames, const WatchWeights& weights,
                           int most_iterations, WatchUnknowns& at);

}  // namespace handeye
