// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/session/guidance.hpp"
#include "daemon/session/provisional.hpp"

namespace handeye {

/// How far a running calibration is, for whoever looks on.
struct CalibrationProgress {
  Situation situation;
  Provisional provisional;  ///< as last solved: some frames behind
  Guidance guidance;        ///< steadied
};

}  // namespace handeye
