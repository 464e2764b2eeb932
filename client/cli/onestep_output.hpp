// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "client/cli/terminal.hpp"
#include "daemon/handeye/perspective/one_step.hpp"

namespace handeye::cli {

/// The result of `handeye onestep` (docs/onestep.md). Chung's k1 is named k1_per_mm2 and never
/// stands under `distortion`, which is OpenCV's.
nlohmann::ordered_json onestep_json(const PerspectiveCalibration& calibration,
                                    const Observations& observations);
nlohmann::ordered_json onestep_json(const PerspectiveRefusal& refusal);

/// The same for people.
std::string onestep_text(const PerspectiveCalibration& calibration,
                         const Observations& observations, const Palette& palette);
std::string onestep_text(const PerspectiveRefusal& refusal, const Palette& palette);

}  // namespace handeye::cli
