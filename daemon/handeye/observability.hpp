// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string_view>

#include "daemon/handeye/maximum_likelihood.hpp"

namespace handeye {

/// What the information matrix says about an answer: the direction that it determines least.
struct Observability {
  struct Direction {
    Eigen::Vector3d axis_in_hand{Eigen::Vector3d::UnitX()};
    double sigma{0};
  };
  Direction rotation_deg;    ///< about the axis
  Direction translation_mm;  ///< along the axis
};

/// From a covariance of (w [rad], dt [mm]) of hand_from_eye.
Observability observability(const Matrix6d& covariance);

/// What a person who holds the scope can do about it. Named as seen in the camera's picture.
enum class MissingMotion {
  kNone,
  kTiltUpAndDown,     ///< turn about the camera's x
  kTurnLeftAndRight,  ///< about its y
  kRoll,              ///< about its z
  kSlideInAndOut,     ///< the scale is what is uncertain
  kSlideSideways,     ///< there is no parallax
  kKeepMoving,        ///< of everything there was some: more of it
};

/// The turn that would tell most: of those that show the weak direction of hand_from_eye (about
/// axes across it: (R - I) times it is what is seen of it) the one that there was clearly least of.
/// kKeepMoving where there was enough of each, kNone without observations.
MissingMotion missing_turn(std::span<const HandEyeObservation> observations,
                           const Pose& hand_from_eye, const Eigen::Vector3d& weak_axis_in_hand);

/// "tilt the scope up and down"; empty for kNone.
std::string_view words(MissingMotion missing);

/// "tilt_up_and_down": the same for programs; empty for kNone.
std::string_view word(MissingMotion missing);

}  // namespace handeye
