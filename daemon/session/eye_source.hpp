// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>

#include "daemon/geometry/board.hpp"
#include "daemon/geometry/camera_model.hpp"
#include "daemon/geometry/intrinsics_mode.hpp"
#include "daemon/handeye/types.hpp"
#include "daemon/reconstruction/reconstruction.hpp"

namespace handeye {

/// Where the eye is in its scene, frame by frame, from what was seen in the images. Two exist: the
/// reconstruction of whatever is in view, and a board of known size. One thread; deterministic.
class EyeSource {
 public:
  EyeSource() = default;
  EyeSource(const EyeSource&) = delete;
  EyeSource& operator=(const EyeSource&) = delete;
  virtual ~EyeSource() = default;

  /// Whether its translations are in mm.
  virtual ScaleMode scale() const = 0;

  /// Takes the next frame. kTracking: the frame, or those about it, could be registered.
  virtual ReconstructionState add(const TrackedFrame& frame) = 0;

  /// The frames registered so far. Cheap.
  virtual Reconstruction current() const = 0;

  /// The same as good as it gets; more may be added after it.
  virtual Reconstruction finish() = 0;

  virtual int keyframes() const = 0;
};

/// `board`: nothing reconstructs. `intrinsics`: what a reconstruction does about the lens; a
/// board's poses are found with the lens as given.
std::unique_ptr<EyeSource> make_eye_source(const std::optional<Board>& board,
                                           const CameraModel& camera, IntrinsicsMode intrinsics,
                                           const ReconstructionOptions& options);

}  // namespace handeye
