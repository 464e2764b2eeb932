// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "daemon/geometry/pose.hpp"

namespace handeye {

/// A body's motion in a few figures.
struct MotionFacts {
  /// Rms turn about the three principal axes, largest first [rad], against the mean attitude.
  Eigen::Vector3d principal_rotation_rad{Eigen::Vector3d::Zero()};
  double path_rms{0};   ///< of the origin about its mean
  double pivot_rms{0};  ///< what is left of it when the body turns about the best fixed point
};

/// a_from_body: the body in a frame at rest, in any unit of length.
MotionFacts motion_facts(std::span<const Pose> a_from_body);

/// Rms turn about the camera's x (up and down), y (left and right) and z (roll) [deg], against the
/// mean attitude. Zero without poses.
Eigen::Vector3d turned_deg(std::span<const Pose> room_from_hand, const Pose& hand_from_eye);

}  // namespace handeye
