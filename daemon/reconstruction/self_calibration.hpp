// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "daemon/geometry/lens_parameters.hpp"
#include "daemon/reconstruction/reconstruction.hpp"

namespace handeye {

/// A reconstruction that finds the lens as well. It keeps what was tracked and reconstructs under a
/// working lens: the given one (kRefine), or the best of several tried once the image has moved
/// enough (kEstimate). `finish` adjusts poses, points and lens together, reconstructs again where
/// the lens changed much, and goes on until it stays. The answer is the reconstruction under the
/// lens that was found, which says how well it is known, and whether the images tell it at all.
/// Deterministic. One thread.
class SelfCalibration {
 public:
  /// `camera`: of kEstimate only the size of the image is used.
  SelfCalibration(const CameraModel& camera, IntrinsicsMode mode,
                  const ReconstructionOptions& options = {});

  /// As IncrementalReconstruction's; once, when a first lens is found, it takes seconds.
  ReconstructionState add(const TrackedFrame& frame);

  /// The reconstruction under the working lens. Cheap.
  Reconstruction current() const;

  /// May be called more than once, and frames may be added after it.
  Reconstruction finish();

  int keyframes() const { return working_->keyframes(); }

 private:
  void begin_again(const CameraModel& camera);
  void look_for_start();
  Reconstruction settle();
  void judge_lens(Reconstruction& reconstruction) const;

  IntrinsicsMode mode_;
  ReconstructionOptions options_;
  CameraModel camera_;  ///< the working lens
  LensPrior prior_;
  std::unique_ptr<IncrementalReconstruction> working_;
  std::vector<TrackedFrame> frames_;  ///< all there were
  bool started_{false};               ///< the working lens is more than a guess
  bool settled_{false};               ///< the last rounds of finish() agreed on the lens
  double moved_px_{0};                ///< image movement summed over the frames
  double look_at_px_{0};              ///< a first lens is looked for when it reaches this
};

}  // namespace handeye
