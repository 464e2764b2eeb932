// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "daemon/session/result.hpp"

namespace handeye {
namespace {

struct ReasonText {
  Reason reason;
  std::string_view word;
  std::string_view advice;
};

constexpr std::array kReasons{
    ReasonText{Reason::kNone, "", ""},
    ReasonText{Reason::kInsufficientRotation, "insufficient_rotation",
               "Tilt the scope: up and down, then left and right, by 20 degrees or more."},
    ReasonText{Reason::kInsufficientTranslation, "insufficient_translation",
               "Slide the scope sideways and in and out, by 15 mm or more."},
    ReasonText{Reason::kNoMotion, "no_motion",
               "Move the scope over the scene all the time: tilt it and slide it."},
    ReasonText{Reason::kSingleAxis, "single_axis",
               "All rotations were about one axis: tilt the scope about another one as well."},
    ReasonText{Reason::kFixedPoint, "fixed_point",
               "The scope turned about one fixed point: slide it in and out as well."},
    ReasonText{Reason::kNoParallax, "no_parallax",
               "The camera turned on the spot: slide the scope sideways over the scene."},
    ReasonText{
        Reason::kTooFewFeatures, "too_few_features",
        "Too little to follow in the image: go nearer to a textured surface, give more light, "
        "move slower."},
    ReasonText{Reason::kImageDark, "image_dark",
               "The picture was dark: switch the light on, take the lens cap off, clean the lens."},
    ReasonText{Reason::kImageFrozen, "image_frozen",
               "The picture stood still while the scope moved: check the camera's cable, and that "
               "the video processor does not hold its picture."},
    ReasonText{
        Reason::kTrackerLost, "tracker_lost",
        "The tracker did not see the scope: keep its markers in the tracker's view, and check "
        "that the tracker sends to this computer."},
    ReasonText{Reason::kCameraLost, "camera_lost",
               "The camera sent no usable images: check its cable and that it is switched on."},
    ReasonText{
        Reason::kClockUnstable, "clock_unstable",
        "The time offset between camera and tracker could not be found: move the scope faster "
        "and less regularly, and check both devices' clocks."},
    ReasonText{Reason::kLensUnobservable, "lens_unobservable",
               "The images do not tell the lens: go closer and farther and tilt more, or give the "
               "camera's intrinsics."},
    ReasonText{Reason::kUncertain, "uncertain",
               "The result is not certain enough: move longer, with larger tilts and slides."},
    ReasonText{Reason::kCancelled, "cancelled", ""},
};

const ReasonText& text_of(Reason reason) {
  for (const ReasonText& text : kReasons) {
    if (text.reason == reason) return text;
  }
  return kReasons.front();
}

}  // namespace

std::string_view reason_word(Reason reason) {
  return text_of(reason).word;
}

std::string_view reason_advice(Reason reason) {
  return text_of(reason).advice;
}

std::string reason_advice(Reason reason, const Board& board) {
  if (reason == Reason::kTooFewFeatures) {
    return "The board " + to_string(board) +
           " was not seen, or in too few images: hold it wholly in view, well lit, and check that "
           "its counts are those of the inner corners (ChArUco: of the squares).";
  }
  if (reason == Reason::kUncertain) {
    return "The result is not certain enough: move longer, with larger tilts, and check the "
           "board's lengths and the camera's intrinsics.";
  }
  return std::string(reason_advice(reason));
}

Reason reason_from_word(std::string_view word) {
  for (const ReasonText& text : kReasons) {
    if (text.word == word) return text.reason;
  }
  return Reason::kUncertain;
}

}  // namespace handeye
