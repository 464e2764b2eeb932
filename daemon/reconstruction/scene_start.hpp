// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/reconstruction/frame_record.hpp"
#include "daemon/reconstruction/reconstruction.hpp"
#include "daemon/reconstruction/scene.hpp"

namespace handeye {

struct StartAttempt {
  bool costly{false};  ///< got as far as computing motions: not to be repeated for every frame
  /// kTracking with a scene; else why there is none.
  ReconstructionState state{ReconstructionState::kTooFewFeatures};
  std::optional<Scene>
      scene;  ///< adjusted; its first keyframe is the origin, the first baseline the unit
};

/// Tries to start a reconstruction between the first and the last of some frames in order of time.
/// Every motion that the two views allow is carried through frames between them and adjusted; the
/// one that leaves the smallest error wins, if it wins clearly.
StartAttempt start_scene(const CameraModel& camera, const ReconstructionOptions& options,
                         std::span<const FrameRecord> frames);

}  // namespace handeye
