// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "daemon/geometry/pose.hpp"

namespace handeye::simulator {

/// The camera head is turned against the scope, after which no calibration from before holds. The
/// scope, with the tracked body on it, goes on as if nothing had happened.
struct HeadTurn {
  enum class About {
    kRoll,  ///< the optical axis (z)
    kTilt,  ///< the image's x axis: up and down
    kTurn,  ///< the image's y axis: left and right
  };

  double at_s{0};  ///< simulated time it begins at; half a second later it is done
  double deg{0};
  About about{About::kRoll};

  bool operator==(const HeadTurn&) const = default;
};

/// Reads SECONDS:DEG[:roll|tilt|turn]. Throws UsageError, one line.
HeadTurn parse_head_turn(std::string_view text);

/// The same spelling again.
std::string spelling(const HeadTurn& turn);

/// Where the eye is in its own frame from before, at a time: identity until it begins.
Pose old_eye_from_eye(const HeadTurn& turn, double time_s);

}  // namespace handeye::simulator
