// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "daemon/handeye/maximum_likelihood.hpp"
#include "daemon/handeye/observability.hpp"

namespace handeye {

/// What is wrong with a motion, in the order in which it is said (docs/math.md section 10).
enum class MotionProblem {
  kNone,
  kNoMotion,              ///< nothing above the noise
  kInsufficientRotation,  ///< translation only
  kNoParallax,            ///< rotation about the camera's centre
  kSingleAxis,            ///< all rotations about one axis
  kFixedPoint,            ///< a pivot: scale and lever arm cannot be told apart
  kUncertain,             ///< none of these, but not good enough
};

/// What is wrong with a motion that did not suffice. `scale_to_blame`: whether the scale is what
/// the answer does not know; nothing where there is no answer to tell, only the look of the motion.
MotionProblem motion_problem(std::span<const HandEyeObservation> observations,
                             const PoseNoise& noise, ScaleMode scale,
                             std::optional<bool> scale_to_blame = {});

/// What the hand's motion alone says, for when there are no eye poses: kNoMotion,
/// kInsufficientRotation, kSingleAxis, kFixedPoint or kNone. With `images_without_parallax` (the
/// reconstruction saw rotation only) a motion that turns is called kNoParallax.
MotionProblem classify_hand_motion(std::span<const Pose> room_from_hand, const PoseNoise& noise,
                                   bool images_without_parallax = false);

/// What helps against it where nothing is known of the camera's axes; kNone for kNone.
MissingMotion remedy(MotionProblem problem);

}  // namespace handeye
