// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "daemon/session/calibration_options.hpp"
#include "daemon/session/calibration_snapshot.hpp"
#include "daemon/session/eye_source.hpp"
#include "daemon/session/guidance.hpp"
#include "daemon/session/hand_path.hpp"
#include "daemon/session/image_health.hpp"
#include "daemon/session/provisional.hpp"
#include "daemon/session/result.hpp"
#include "daemon/sync/pose_buffer.hpp"

namespace handeye {

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

  /// How far it is. Cheap.
  Situation situation() const;
  /// What provisional() needs: what is there, without the global adjustment. About a millisecond.
  ProvisionalSnapshot outline() const;

  /// What the result rests on, after the global adjustment: some tenths of a second, and several
  /// times that where the lens is found with it. More may be added after it.
  CalibrationSnapshot snapshot();
  /// The result from what is there: solves snapshot(), and learns from it.
  CalibrationResult solve();
  /// For the outlines that follow: what the answer to a snapshot says of the lens.
  void learn(const SolvedCalibration& outcome) { lens_covariance_ = outcome.lens_covariance; }

  const CalibrationOptions& options() const { return options_; }

 private:
  CalibrationResult begin_result() const;
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
  std::optional<Matrix6d> lens_covariance_;  ///< as last learnt; zero where the lens is given
};

}  // namespace handeye
