// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/guidance.hpp"

namespace handeye {
namespace {

// Where more of it still helps noticeably; the verdict rests on sigma, not on these.
constexpr double kFewFeatures = 40;
constexpr double kEnoughRotation_deg = 20;
constexpr double kEnoughSecondAxis_deg = 3;
constexpr double kEnoughTranslation_mm = 15;

/// About the picture itself; kNone: it is as it should be, or as good as it can be.
Guidance about_picture(const Situation& situation) {
  switch (situation.images) {
    case ImageCondition::kUnusable:
      return {GuideCode::kImageUnusable,
              "the camera's images cannot be used: check its settings and its cable"};
    case ImageCondition::kDark:
      return {GuideCode::kTooDark, "too dark: switch the light on, take the lens cap off"};
    case ImageCondition::kFrozen:
      return {GuideCode::kFrozen, "the picture is frozen: check the camera's cable"};
    case ImageCondition::kBright:
      return {GuideCode::kTooBright, "picture too bright: draw back, or turn the light down"};
    case ImageCondition::kBlurred:
      return {GuideCode::kSlower, "slower: the picture is blurred"};
    default:
      return {};
  }
}

/// About what is in view; kNone: it is as it should be.
Guidance about_scene(const Situation& situation) {
  if (situation.features_recent >= kFewFeatures) return {};
  return {GuideCode::kLittleToSee,
          "too little to see: go nearer to a textured surface, or give more light"};
}

Guidance about_board(const Situation& situation) {
  if (situation.keyframes == 0) {
    return {GuideCode::kShowBoard, "show the board to the scope: " + to_string(*situation.board)};
  }
  if (situation.state == ReconstructionState::kTracking) return {};
  if (situation.board->kind == Board::Kind::kChessboard || situation.features_recent > 0) {
    return {GuideCode::kWholeBoard,
            "board not wholly in view: point the scope at its middle, or draw back"};
  }
  return {GuideCode::kShowBoard, "board not in view: point the scope at it"};
}

Guidance ask_for(MissingMotion missing) {
  GuideCode code = GuideCode::kNone;
  switch (missing) {
    case MissingMotion::kNone:
      break;
    case MissingMotion::kTiltUpAndDown:
      code = GuideCode::kTiltUpAndDown;
      break;
    case MissingMotion::kTurnLeftAndRight:
      code = GuideCode::kTurnLeftAndRight;
      break;
    case MissingMotion::kRoll:
      code = GuideCode::kRoll;
      break;
    case MissingMotion::kSlideInAndOut:
      code = GuideCode::kSlideInAndOut;
      break;
    case MissingMotion::kSlideSideways:
      code = GuideCode::kSlideSideways;
      break;
    case MissingMotion::kKeepMoving:
      code = GuideCode::kKeepMoving;
      break;
  }
  return {code, std::string(words(missing))};
}

/// From the hand's path alone: its axes are not the picture's as long as hand_from_eye is unknown.
MissingMotion missing_by_path(const Situation& situation) {
  if (situation.rotation_coverage_deg < kEnoughRotation_deg) return MissingMotion::kTiltUpAndDown;
  if (situation.second_axis_deg < kEnoughSecondAxis_deg) return MissingMotion::kTurnLeftAndRight;
  // Against a board the scale is known, and tilting is all that is needed.
  if (situation.board) return MissingMotion::kNone;
  const bool parallax = situation.state == ReconstructionState::kTracking;
  return parallax && situation.translation_coverage_mm >= kEnoughTranslation_mm
             ? MissingMotion::kNone
             : MissingMotion::kSlideSideways;
}

}  // namespace

Guidance guidance_for(const Situation& situation, const Provisional& so_far) {
  if (!situation.any_frame) return {GuideCode::kNoImage, "no image from the camera yet"};
  if (situation.hand_hidden) {
    return {GuideCode::kHandHidden, "scope hidden from the tracker: turn its markers towards it"};
  }
  if (Guidance picture = about_picture(situation); picture.code != GuideCode::kNone) {
    return picture;
  }
  Guidance view = situation.board ? about_board(situation) : about_scene(situation);
  if (view.code != GuideCode::kNone) return view;
  return ask_for(so_far.missing.value_or(missing_by_path(situation)));
}

}  // namespace handeye
