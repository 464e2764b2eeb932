// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "daemon/session/guidance.hpp"

namespace handeye {

struct SteadyGuidanceOptions {
  double shown_s{2};      ///< what is shown stays so long at least
  double settled_s{0.4};  ///< what is to replace it must have been due so long, without a break
};

/// Guidance that a person can follow: it does not flicker between two words. Knows no clock but the
/// times that it is given. Not synchronised: one owner.
class SteadyGuidance {
 public:
  explicit SteadyGuidance(const SteadyGuidanceOptions& options = {}) : options_(options) {}

  /// What to show at `time_s`, when `due` is what there is to say. Times in order. The first thing
  /// to say is shown at once; the same code with other words replaces them at once.
  const Guidance& show(const Guidance& due, double time_s);

 private:
  SteadyGuidanceOptions options_;
  std::optional<Guidance> shown_;  ///< nothing: nothing yet
  double shown_since_s_{0};
  GuideCode candidate_{GuideCode::kNone};
  double candidate_since_s_{0};
};

}  // namespace handeye
