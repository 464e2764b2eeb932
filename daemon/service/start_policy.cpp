// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/start_policy.hpp"

#include <algorithm>

namespace handeye {

using dtrack::CommandOutcome;

StartPolicy::StartPolicy(std::int64_t now_ns, const StartPolicyOptions& options)
    : options_(options), next_ns_(now_ns + options.settle_ns), retry_ns_(options.first_retry_ns) {}

bool StartPolicy::is_due(std::int64_t now_ns, std::int64_t last_packet_ns) {
  if (last_packet_ns > packet_ns_) {
    packet_ns_ = last_packet_ns;
    next_ns_ = last_packet_ns + options_.silence_ns;
    retry_ns_ = options_.first_retry_ns;
    answered_ = 0;
    flowed_ = true;
  }
  if (now_ns < next_ns_ || has_given_up()) return false;
  // It was cut off or switched off; if it comes back by itself, somebody else saw to that.
  if (flowed_) ours_ = false;
  return true;
}

void StartPolicy::note(const dtrack::CommandReport& report, std::int64_t now_ns) {
  flowed_ = false;
  if (report.outcome == CommandOutcome::kDone) ours_ = true;
  const bool nobody_there = report.outcome == CommandOutcome::kUnreachable ||
                            report.outcome == CommandOutcome::kInterrupted;
  if (!nobody_there) ++answered_;
  next_ns_ = now_ns + retry_ns_;
  retry_ns_ = std::min(2 * retry_ns_, options_.last_retry_ns);
}

double StartPolicy::next_in_s(std::int64_t now_ns) const {
  if (has_given_up()) return 0;
  return 1e-9 * static_cast<double>(std::max<std::int64_t>(next_ns_ - now_ns, 0));
}

}  // namespace handeye
