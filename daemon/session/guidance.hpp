// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "daemon/geometry/board.hpp"
#include "daemon/reconstruction/reconstruction.hpp"
#include "daemon/session/provisional.hpp"
#include "daemon/tracking/image_condition.hpp"

namespace handeye {

/// What is known while collecting, for saying what to do next.
struct Situation {
  std::optional<Board> board;  ///< to be looked at; nothing: whatever is in view
  bool any_frame{false};
  bool hand_hidden{false};                       ///< in the tracker's last samples
  ImageCondition images{ImageCondition::kGood};  ///< what ails most of the last ones
  double features_recent{0};  ///< tracked in the last frame; of a board: its corners
  ReconstructionState state{ReconstructionState::kTooFewFeatures};
  int keyframes{0};                 ///< of a board: views in which it could be located
  double rotation_coverage_deg{0};  ///< largest rotation of the hand since the first sample
  /// Rotation about the axis that was turned about second most [deg, rms]: both are needed.
  double second_axis_deg{0};
  double translation_coverage_mm{0};  ///< largest translation of the hand since the first sample
};

/// The one thing to do next, as status_t's GUIDE constants have it.
enum class GuideCode {
  kNone,
  kNoImage,
  kHandHidden,
  kImageUnusable,
  kTooDark,
  kFrozen,
  kTooBright,
  kSlower,
  kLittleToSee,
  kShowBoard,
  kWholeBoard,
  kTiltUpAndDown,
  kTurnLeftAndRight,
  kRoll,
  kSlideInAndOut,
  kSlideSideways,
  kKeepMoving,
};

struct Guidance {
  GuideCode code{GuideCode::kNone};
  std::string words;  ///< for the person who holds the scope; empty: go on

  bool operator==(const Guidance&) const = default;
};

/// What is in the way of an answer goes first: tracker, picture, view. Then the motion that is
/// missing: what the information of the answer so far says, and before there is any, the movement
/// itself.
Guidance guidance_for(const Situation& situation, const Provisional& so_far = {});

}  // namespace handeye
