// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/motion_problem.hpp"

#include <algorithm>
#include <vector>

#include "daemon/handeye/motion_facts.hpp"
#include "daemon/handeye/parts.hpp"
#include "daemon/handeye/usable.hpp"

namespace handeye {
namespace {

// These only choose the words for a motion that did not suffice; what suffices is for the
// covariance.
constexpr double kAboveNoise = 5.0;         // standard deviations
constexpr double kStillRotation_deg = 0.3;  // rms of a hand that is kept still
constexpr double kStillPath_mm = 0.75;
constexpr double kMinRotation_deg = 2.0;  // rms; less is the wobble of a straight movement
constexpr double kMinSecondAxis = 0.12;   // second principal turn to the first
constexpr double kMaxPivotShare = 0.05;   // of the path left by the best fixed point: a pivot
constexpr double kExplained = 0.5;        // of the eye's path by a fixed point: no mere noise

/// Of hand and eye, over poses that share a scene.
struct Motion {
  MotionFacts hand;
  MotionFacts eye;
};

bool pivots(const MotionFacts& hand, const PoseNoise& noise) {
  return hand.pivot_rms <
         std::max(kAboveNoise * noise.hand_translation_mm, kMaxPivotShare * hand.path_rms);
}

/// The hand turns about the camera's centre: it pivots, and the eye's own path is no consequence of
/// its turning, hence noise.
bool turns_about_camera(const Motion& motion, const PoseNoise& noise) {
  return pivots(motion.hand, noise) && motion.eye.pivot_rms >= kExplained * motion.eye.path_rms;
}

/// `without_parallax`: the camera was seen to turn on the spot.
MotionProblem classify(const MotionFacts& hand, const PoseNoise& noise, bool without_parallax,
                       ScaleMode scale) {
  const Eigen::Vector3d& turn = hand.principal_rotation_rad;
  const double noise_turn = kAboveNoise * noise.hand_rotation_rad;
  const bool turns = turn.norm() > std::max(noise_turn, rad_from_deg(kStillRotation_deg));
  const bool moves =
      hand.path_rms > std::max(kAboveNoise * noise.hand_translation_mm, kStillPath_mm);
  if (!turns && !moves) return MotionProblem::kNoMotion;
  if (turn[0] < std::max(noise_turn, rad_from_deg(kMinRotation_deg))) {
    return MotionProblem::kInsufficientRotation;
  }
  if (without_parallax) return MotionProblem::kNoParallax;
  if (turn[1] < std::max(noise_turn, kMinSecondAxis * turn[0])) return MotionProblem::kSingleAxis;
  if (scale == ScaleMode::kUnknown && pivots(hand, noise)) return MotionProblem::kFixedPoint;
  return MotionProblem::kNone;
}

/// In every part that counts.
bool turns_about_camera(std::span<const HandEyeObservation> observations, const PoseNoise& noise) {
  const std::vector<Part> parts = parts_of(observations);
  return std::ranges::all_of(parts, [&](const Part& part) {
    const bool counts =
        part.number == parts.front().number || part.members.size() >= kFewestPosesOfPart;
    if (!counts) return true;
    std::vector<Pose> hand;
    std::vector<Pose> eye;
    for (const PosePair& pair : poses_of(observations, part)) {
      hand.push_back(pair.room_from_hand);
      eye.push_back(pair.eye_from_scene.inverse());
    }
    return turns_about_camera({motion_facts(hand), motion_facts(eye)}, noise);
  });
}

}  // namespace

MotionProblem motion_problem(std::span<const HandEyeObservation> observations,
                             const PoseNoise& noise, ScaleMode scale,
                             std::optional<bool> scale_to_blame) {
  std::vector<HandEyeObservation> usable;
  std::vector<Pose> hand;
  for (const HandEyeObservation& observation : observations) {
    if (!are_usable({&observation.poses, 1})) continue;
    usable.push_back(observation);
    hand.push_back(observation.poses.room_from_hand);
  }
  const bool on_the_spot =
      scale == ScaleMode::kUnknown && !usable.empty() && turns_about_camera(usable, noise);
  const MotionProblem problem = classify(motion_facts(hand), noise, on_the_spot, scale);
  if (problem != MotionProblem::kFixedPoint && problem != MotionProblem::kNone) return problem;
  // The sigma of the scale decides whether a pivot is to blame, not how the motion looks.
  const bool pivot = scale_to_blame.value_or(problem == MotionProblem::kFixedPoint);
  return pivot ? MotionProblem::kFixedPoint : MotionProblem::kUncertain;
}

MotionProblem classify_hand_motion(std::span<const Pose> room_from_hand, const PoseNoise& noise,
                                   bool images_without_parallax) {
  return classify(motion_facts(room_from_hand), noise, images_without_parallax,
                  ScaleMode::kUnknown);
}

MissingMotion remedy(MotionProblem problem) {
  switch (problem) {
    case MotionProblem::kNone:
      return MissingMotion::kNone;
    case MotionProblem::kNoMotion:
    case MotionProblem::kInsufficientRotation:
      return MissingMotion::kTiltUpAndDown;
    case MotionProblem::kNoParallax:
      return MissingMotion::kSlideSideways;
    case MotionProblem::kFixedPoint:
      return MissingMotion::kSlideInAndOut;
    case MotionProblem::kSingleAxis:
    case MotionProblem::kUncertain:
      break;
  }
  return MissingMotion::kKeepMoving;
}

}  // namespace handeye
