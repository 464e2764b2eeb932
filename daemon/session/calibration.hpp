// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/handeye/types.hpp"
#include "daemon/reconstruction/reconstruction.hpp"
#include "daemon/session/estimate.hpp"
#include "daemon/session/eye_source.hpp"
#include "daemon/session/hand_path.hpp"
#include "daemon/session/image_health.hpp"
#include "daemon/session/result.hpp"
#include "daemon/session/session.hpp"
#include "daemon/sync/pose_buffer.hpp"

namespace handeye {

struct CalibrationOptions {
  StartOptions start;  ///< with a board: the eye's poses come from it
  CameraModel camera;  ///< with kEstimate and no board only its width and height count
  IntrinsicsMode intrinsics{IntrinsicsMode::kFixed};  ///< of a reconstruction
  PoseNoise noise;  ///< of the tracker; the eye's is found from the data
  ReconstructionOptions reconstruction;
  std::size_t hand_capacity{65'536};  ///< samples of the hand kept; the oldest go first
};

/// How far a running calibration is.
struct CalibrationProgress {
  int keyframes{0};
  double rotation_coverage_deg{0};    ///< largest rotation of the hand since the first sample
  double translation_coverage_mm{0};  ///< largest translation of the hand since then
  /// So far; nothing: not known yet. What an uncertain lens adds only solve() finds: until it has
  /// found a lens that was not given there is none, then it is added as it was there.
  std::optional<double> sigma_rotation_deg;
  std::optional<double> sigma_translation_mm;
  /// The same without the lens's part: solve() is worth trying when this is small enough. Nothing
  /// also where the hand contradicts the lens.
  std::optional<MethodSigma> sigma_beside_lens;
  std::string guidance;  ///< the one thing to do next, for the person with the scope
};

/// One calibration from its streams to its result: the eye's poses, time offset, hand-eye, verdict.
/// Knows no thread and no clock but the stamps it is given; the same in the daemon and in a replay,
/// and the same answer for the same input, bit for bit (timings aside). One thread.
class Calibration {
 public:
  explicit Calibration(const CalibrationOptions& options);

  /// Samples of the hand, in order of time.
  void add_hand(const HandSample& sample);
  /// What an ImageStage of the same board, or of none, saw; in order of time. Milliseconds, now and
  /// then some ten; seconds when a lens is looked for (kEstimate: once, or a few times in vain).
  void add_frame(const TrackedFrame& frame);

  /// An estimate from what is there, without the global adjustment: some ten milliseconds.
  CalibrationProgress progress() const;
  /// The result from what is there: up to seconds, and several times that where the lens is found
  /// with it. More may be added after it, and solve() called again.
  CalibrationResult solve();

  const CalibrationOptions& options() const { return options_; }

 private:
  bool is_lens_given() const {
    return options_.start.board || options_.intrinsics == IntrinsicsMode::kFixed;
  }
  void tell_sigma(const Estimate& so_far, CalibrationProgress& progress) const;
  CalibrationResult begin_result() const;
  std::string advice_for(Reason reason, const Estimate& found) const;
  Reconstruction reconstruct(CalibrationResult& result);

  CalibrationOptions options_;
  std::unique_ptr<EyeSource> eye_;
  ReconstructionState state_{ReconstructionState::kTooFewFeatures};
  PoseBuffer hand_;
  HandPath hand_path_;
  bool hand_hidden_{false};  ///< in the last sample
  std::int64_t frames_{0};
  ImageHealth images_;
  std::int64_t features_{0};  ///< summed over the frames
  int features_recent_{0};    ///< in the last frame
  double reconstruction_ms_{0};
  std::optional<Matrix6d> lens_covariance_;  ///< of the last solve(); zero where the lens is given
};

}  // namespace handeye
