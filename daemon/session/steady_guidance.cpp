// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/steady_guidance.hpp"

namespace handeye {

const Guidance& SteadyGuidance::show(const Guidance& due, double time_s) {
  if (due.code != candidate_) {
    candidate_ = due.code;
    candidate_since_s_ = time_s;
  }
  const bool same = shown_.code == due.code;
  const bool may_change = time_s - shown_since_s_ >= options_.shown_s &&
                          time_s - candidate_since_s_ >= options_.settled_s;
  if (!same && may_change) shown_since_s_ = time_s;
  if (same || may_change) shown_ = due;
  return shown_;
}

}  // namespace handeye
