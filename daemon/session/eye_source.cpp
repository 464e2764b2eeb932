// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/eye_source.hpp"

#include <utility>

#include "daemon/reconstruction/self_calibration.hpp"
#include "daemon/session/board_eye.hpp"

namespace handeye {
namespace {

/// Whatever is in view, reconstructed with a lens that is given or, by SelfCalibration, found.
template <typename ReconstructionKind>
class SceneEye final : public EyeSource {
 public:
  template <typename... Arguments>
  explicit SceneEye(Arguments&&... arguments)
      : reconstruction_(std::forward<Arguments>(arguments)...) {}

  ScaleMode scale() const override { return ScaleMode::kUnknown; }
  ReconstructionState add(const TrackedFrame& frame) override { return reconstruction_.add(frame); }
  Reconstruction current() const override { return reconstruction_.current(); }
  Reconstruction finish() override { return reconstruction_.finish(); }
  int keyframes() const override { return reconstruction_.keyframes(); }

 private:
  ReconstructionKind reconstruction_;
};

}  // namespace

std::unique_ptr<EyeSource> make_eye_source(const std::optional<Board>& board,
                                           const CameraModel& camera, IntrinsicsMode intrinsics,
                                           const ReconstructionOptions& options) {
  if (board) return std::make_unique<BoardEye>(*board, camera);
  if (intrinsics == IntrinsicsMode::kFixed) {
    return std::make_unique<SceneEye<IncrementalReconstruction>>(camera, options);
  }
  return std::make_unique<SceneEye<SelfCalibration>>(camera, intrinsics, options);
}

}  // namespace handeye
