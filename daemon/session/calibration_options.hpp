// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/geometry/intrinsics_mode.hpp"
#include "daemon/handeye/one_step/one_step.hpp"
#include "daemon/handeye/types.hpp"
#include "daemon/reconstruction/reconstruction.hpp"
#include "daemon/session/session.hpp"

namespace handeye {

struct CalibrationOptions {
  StartOptions start;  ///< with a board: the eye's poses come from it
  CameraModel camera;  ///< with kEstimate and no board only its width and height count
  IntrinsicsMode intrinsics{IntrinsicsMode::kFixed};  ///< of a reconstruction
  PoseNoise noise;  ///< of the tracker; the eye's is found from the data
  HandNoiseSource hand_noise{HandNoiseSource::kMeasured};  ///< see estimate_in_one_step
  ReconstructionOptions reconstruction;
  std::size_t hand_capacity{65'536};  ///< samples of the hand kept; the oldest go first

  bool is_lens_given() const { return start.board || intrinsics == IntrinsicsMode::kFixed; }
};

}  // namespace handeye
