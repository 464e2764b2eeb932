// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tests/unit/handeye/one_step_scenes.hpp"

namespace handeye::bench {

struct OneStepCase {
  std::string name;
  synthetic::OneStepSceneOptions options;
  HandNoiseSource source{HandNoiseSource::kEstimated};
  int bound_every{1};    ///< seed whose bound is computed
  int most_seeds{1000};  ///< large ones take long
};

std::vector<OneStepCase> one_step_cases();

}  // namespace handeye::bench
