// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include "daemon/session/guidance.hpp"

namespace handeye {

struct SteadyGuidanceOptions {
  double shown_s{2};      ///< what is shown stays so long at least
  double settled_s{0.4};  ///< what is to be shown must have been due so long, without a break
};

/// Guidance that a person can follow: it does not flicker between two words. Knows no clock but the
/// times that it is given. Not synchronised: one owner.
class SteadyGuidance {
 public:
  explicit SteadyGuidance(const SteadyGuidanceOptions& options = {}) : options_(options) {}

  /// What to show at `time_s`, when `due` is what there is to say. Times in order; nothing is shown
  /// at first. The same code with other words replaces them at once.
  const Guidance& show(const Guidance& due, double time_s);

 private:
  SteadyGuidanceOptions options_;
  Guidance shown_;
  double shown_since_s_{-std::numeric_limits<double>::infinity()};
  GuideCode candidate_{GuideCode::kNone};
  double candidate_since_s_{0};
};

}  // namespace handeye
