// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/guidance.hpp"

namespace handeye {
namespace {

// Where more of it still helps noticeably; the verdict rests on sigma, not on these.
constexpr double kFewFeatures = 40;
constexpr double kEnoughRotation_deg = 20;
constexpr double kEnoughSecondAxis_deg = 3;
constexpr double kEnoughTranslation_mm = 15;

}  // namespace

std::string guidance_for(const Situation& situation) {
  if (!situation.any_frame) return "no image from the camera yet";
  if (situation.hand_hidden) return "scope hidden from the tracker: turn its markers towards it";
  if (situation.features_recent < kFewFeatures) {
    return "too little to see: go nearer to a textured surface, or give more light";
  }
  if (situation.rotation_coverage_deg < kEnoughRotation_deg) return "tilt the scope up and down";
  if (situation.second_axis_deg < kEnoughSecondAxis_deg) return "tilt the scope left and right";
  if (situation.translation_coverage_mm < kEnoughTranslation_mm) {
    return "slide the scope sideways and in and out";
  }
  if (situation.state != ReconstructionState::kTracking) return "slide the scope sideways";
  return "";
}

}  // namespace handeye
