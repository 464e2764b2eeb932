// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/unit/handeye/synthetic.hpp"

namespace handeye::synthetic {

/// A free hand in which anything can be left out. The camera starts where free_hand's does, looking
/// at the scene from 80 mm.
struct MotionShape {
  Eigen::Vector3d turn_deg{20, 20, 20};        ///< at most, about the camera's x, y, z
  Eigen::Vector3d slide_mm{15, 15, 15};        ///< at most, along its axes at the start
  Eigen::Vector3d centre_in_eye_mm{0, 0, 80};  ///< the turns are about this point
};

/// Smooth, all six as independent as some seconds allow.
Motion shaped_motion(const MotionShape& shape);

inline const Eigen::Vector3d kTrocar_mm{5, -3, -150};  ///< in the eye: behind the camera

}  // namespace handeye::synthetic
