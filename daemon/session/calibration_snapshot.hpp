// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "daemon/reconstruction/reconstruction.hpp"
#include "daemon/session/calibration_options.hpp"
#include "daemon/session/image_health.hpp"
#include "daemon/session/result.hpp"
#include "daemon/sync/pose_buffer.hpp"

namespace handeye {

/// Everything an answer rests on, as it was at one moment. Owns all of it: it may be solved on any
/// thread while the calibration that it was taken of goes on.
struct CalibrationSnapshot {
  CalibrationOptions options;
  CalibrationResult begun;               ///< counts, timings, camera and lens; no answer yet
  Reconstruction reconstruction;         ///< after its global adjustment
  ScaleMode scale{ScaleMode::kUnknown};  ///< of the reconstruction's translations
  PoseBuffer hand;
  std::vector<Pose> hand_path;  ///< room_from_hand, wherever it was tracked, thinned
  ImageHealth images;
};

/// An answer, and what of it serves the provisional ones that follow.
struct SolvedCalibration {
  CalibrationResult result;
  /// What the lens adds to hand_from_eye's; zero where it was given, nothing where it is not known.
  std::optional<Matrix6d> lens_covariance;
};

/// The answer to a snapshot: time offset, hand-eye, verdict. Pure: any thread, the same answer for
/// the same snapshot, bit for bit (timings aside). Up to seconds.
SolvedCalibration solve(const CalibrationSnapshot& snapshot);

}  // namespace handeye
