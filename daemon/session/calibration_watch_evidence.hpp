// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/session/calibration_watch_fit.hpp"

namespace handeye {

struct WatchEvidenceOptions {
  double turned_deg{0.4};  ///< a smaller deviation is none that matters
  double seen_deg{0.3};    ///< a direction whose sigma is larger is not seen
};

/// What a fit says about the calibration in use.
struct WatchEvidence {
  enum class Kind { kNone, kAgrees, kContradicts } kind{Kind::kNone};
  double deviation_deg{0};  ///< turn against the calibration, in the directions that are seen
  double sigma_deg{0};      ///< of it, both sides' uncertainty
  bool measured{false};     ///< any direction of the rotation is seen
};

/// Tests the rotation of the fit's hand_from_eye against the calibrated one, with the covariances
/// of both and by the likelihood's gain, each at 10^-6, in the directions that the motion shows:
/// turning about one axis only shows what is across it. Agreement needs all three directions of the
/// rotation. `covariance`: of the calibration, as in CalibrationResult.
WatchEvidence weigh(const WatchFit& fit, const Pose& hand_from_eye, const Matrix6d& covariance,
                    const WatchEvidenceOptions& options = {});

}  // namespace handeye
