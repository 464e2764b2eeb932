// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/reconstruction/frame_record.hpp"
#include "daemon/reconstruction/reconstruction.hpp"
#include "daemon/reconstruction/scene.hpp"
#include "daemon/reconstruction/start_method.hpp"

namespace handeye {

struct StartAttempt {
  bool costly{false};  ///< got as far as computing motions: not to be repeated for every frame
  /// kTracking with a scene; else why there is none.
  ReconstructionState state{ReconstructionState::kTooFewFeatures};
  StartMethod method{StartMethod::kTwoViews};  ///< that found the scene
  /// Adjusted; its first keyframe is the origin, the distance of the farthest from it about 1.
  std::optional<Scene> scene;
};

/// Tries to start a reconstruction in a stretch of frames in order of time, from features that the
/// first and the last have in common. Every camera motion that factorisation of the stretch or two
/// of its views allow is carried through frames between them and adjusted; the one that leaves the
/// smallest error wins, if it wins clearly.
StartAttempt start_scene(const CameraModel& camera, const ReconstructionOptions& options,
                         std::span<const FrameRecord> frames);

}  // namespace handeye
