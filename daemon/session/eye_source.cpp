// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/eye_source.hpp"

#include "daemon/session/board_eye.hpp"

namespace handeye {
namespace {

class SceneEye final : public EyeSource {
 public:
  SceneEye(const CameraModel& camera, const ReconstructionOptions& options)
      : reconstruction_(camera, options) {}

  ScaleMode scale() const override { return ScaleMode::kUnknown; }
  ReconstructionState add(const TrackedFrame& frame) override { return reconstruction_.add(frame); }
  Reconstruction current() const override { return reconstruction_.current(); }
  Reconstruction finish() override { return reconstruction_.finish(); }
  int keyframes() const override { return reconstruction_.keyframes(); }

 private:
  IncrementalReconstruction reconstruction_;
};

}  // namespace

std::unique_ptr<EyeSource> make_eye_source(const std::optional<Board>& board,
                                           const CameraModel& camera,
                                           const ReconstructionOptions& options) {
  if (board) return std::make_unique<BoardEye>(*board, camera);
  return std::make_unique<SceneEye>(camera, options);
}

}  // namespace handeye
