// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/guidance.hpp"

namespace handeye {
namespace {

// Where more of it still helps noticeably; the verdict rests on sigma, not on these.
constexpr double kFewFeatures = 40;
constexpr double kEnoughRotation_deg = 20;
constexpr double kEnoughSecondAxis_deg = 3;
constexpr double kEnoughTranslation_mm = 15;

/// About the picture itself; empty: it is as it should be, or as good as it can be.
std::string guidance_about_picture(const Situation& situation) {
  switch (situation.images) {
    case ImageCondition::kUnusable:
      return "the camera's images cannot be used: check its settings and its cable";
    case ImageCondition::kDark:
      return "too dark: switch the light on, take the lens cap off";
    case ImageCondition::kFrozen:
      return "the picture is frozen: check the camera's cable";
    case ImageCondition::kBright:
      return "picture too bright: draw back, or turn the light down";
    case ImageCondition::kBlurred:
      return "slower: the picture is blurred";
    default:
      return "";
  }
}

/// About what is in view; empty: it is as it should be.
std::string guidance_about_scene(const Situation& situation) {
  if (situation.features_recent >= kFewFeatures) return "";
  return "too little to see: go nearer to a textured surface, or give more light";
}

std::string guidance_about_board(const Situation& situation) {
  if (!situation.board_seen) return "show the board to the scope: " + to_string(*situation.board);
  if (situation.state == ReconstructionState::kTracking) return "";
  if (situation.board->kind == Board::Kind::kChessboard || situation.features_recent > 0) {
    return "board not wholly in view: point the scope at its middle, or draw back";
  }
  return "board not in view: point the scope at it";
}

std::string guidance_about_motion(const Situation& situation) {
  if (situation.rotation_coverage_deg < kEnoughRotation_deg) return "tilt the scope up and down";
  if (situation.second_axis_deg < kEnoughSecondAxis_deg) return "tilt the scope left and right";
  // Against a board the scale is known, and tilting is all that is needed.
  if (situation.board) return "";
  if (situation.translation_coverage_mm < kEnoughTranslation_mm) {
    return "slide the scope sideways and in and out";
  }
  if (situation.state != ReconstructionState::kTracking) return "slide the scope sideways";
  return "";
}

}  // namespace

std::string guidance_for(const Situation& situation) {
  if (!situation.any_frame) return "no image from the camera yet";
  if (situation.hand_hidden) return "scope hidden from the tracker: turn its markers towards it";
  const std::string about_picture = guidance_about_picture(situation);
  if (!about_picture.empty()) return about_picture;
  const std::string about_view =
      situation.board ? guidance_about_board(situation) : guidance_about_scene(situation);
  return about_view.empty() ? guidance_about_motion(situation) : about_view;
}

}  // namespace handeye
