// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "drivers/dtrack/tracker_commands.hpp"

namespace handeye {

/// Durations in ns.
struct StartPolicyOptions {
  std::int64_t settle_ns{1'000'000'000};       ///< at first, packets may be on their way already
  std::int64_t silence_ns{5'000'000'000};      ///< without packets, before the tracker is asked
  std::int64_t first_retry_ns{5'000'000'000};  ///< doubled with every attempt that brings no packet
  std::int64_t last_retry_ns{60'000'000'000};  ///< at most
  /// In one silence, of those the controller answered: who switches tracking off again and again,
  /// or refuses, means it. While nobody is there the attempts go on: it may yet be switched on.
  int most_answered{8};
};

/// When the controller is asked to start tracking, and whether it was us who started it. Knows no
/// clock and no network: the times are CLOCK_MONOTONIC in ns and come with each call.
class StartPolicy {
 public:
  StartPolicy(std::int64_t now_ns, const StartPolicyOptions& options = {});

  /// Whether to ask now. `last_packet_ns`: arrival of the newest packet; 0: none yet.
  bool is_due(std::int64_t now_ns, std::int64_t last_packet_ns);

  /// What came of it.
  void note(const dtrack::CommandReport& report, std::int64_t now_ns);

  /// The tracking that runs was started by us, as far as can be told: started because nothing came,
  /// and packets have not stayed away since they came. What began after that was somebody else's.
  bool ours() const { return ours_; }

  /// Asked in vain so often that it rests until packets come again.
  bool has_given_up() const { return answered_ >= options_.most_answered; }
  /// Seconds until the next attempt if nothing comes; 0: it is due, or none will follow.
  double next_in_s(std::int64_t now_ns) const;

 private:
  StartPolicyOptions options_;
  std::int64_t next_ns_;       ///< not before
  std::int64_t retry_ns_;      ///< the next wait between attempts
  std::int64_t packet_ns_{0};  ///< the newest known
  int answered_{0};
  bool ours_{false};
  bool flowed_{false};  ///< packets have come since the last attempt
};

}  // namespace handeye
