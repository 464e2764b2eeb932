// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/unit/handeye/one_step_scenes.hpp"

namespace handeye::synthetic {

/// The Cramer-Rao bound of hand_from_eye and the time offset: what no unbiased estimator falls
/// below.
struct OneStepBound {
  Matrix6d hand_from_eye;  ///< of (w [rad], dt [mm]), as OneStepResult's covariance
  double time_offset_s;    ///< standard deviation

  double rotation_deg() const { return sigma_rotation_deg(hand_from_eye); }
  double translation_mm() const { return sigma_translation_mm(hand_from_eye); }
};

/// The inverse Fisher information of the whole problem at the truth: every observation of every
/// frame, all poses and points free, the lens too where it has a prior; the interpolated hand with
/// its exact covariance, shared samples included. By numerical differentiation of what the devices
/// measure, with nothing of a solver's equations.
OneStepBound one_step_bound(const OneStepScene& scene);

}  // namespace handeye::synthetic
