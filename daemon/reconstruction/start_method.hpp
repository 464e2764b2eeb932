// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "daemon/geometry/pose.hpp"

namespace handeye {

/// What a reconstruction was started from.
enum class StartMethod {
  kFactorisation,  ///< all frames of the window at once
  kTwoViews,       ///< essential matrix or homography between two of them
};

/// Where a method believes the cameras of the frames of a start window to be.
struct StartHypothesis {
  StartMethod method{StartMethod::kTwoViews};
  std::vector<std::optional<Pose>> eye_from_scene;  ///< a frame each; nothing where it cannot tell
};

}  // namespace handeye
