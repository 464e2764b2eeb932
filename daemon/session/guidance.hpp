// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "daemon/geometry/board.hpp"
#include "daemon/reconstruction/reconstruction.hpp"
#include "daemon/tracking/image_condition.hpp"

namespace handeye {

/// What is known while collecting, for saying what to do next.
struct Situation {
  std::optional<Board> board;  ///< to be looked at; nothing: whatever is in view
  bool board_seen{false};      ///< it could be located at least once
  bool any_frame{false};
  bool hand_hidden{false};                       ///< in the tracker's last samples
  ImageCondition images{ImageCondition::kGood};  ///< what ails most of the last ones
  double features_recent{0};  ///< tracked in the last frame; of a board: its corners
  ReconstructionState state{ReconstructionState::kTooFewFeatures};
  double rotation_coverage_deg{0};
  /// Rotation about the axis that was turned about second most [deg, rms]: both are needed.
  double second_axis_deg{0};
  double translation_coverage_mm{0};
};

/// The one thing to do next, in a few words for the person who holds the scope; empty: go on.
std::string guidance_for(const Situation& situation);

}  // namespace handeye
