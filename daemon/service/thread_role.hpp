// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace handeye {

/// What a thread is, for the kernel and for whoever looks at it with `ps -L` or `top -H`.
struct ThreadRole {
  std::string name;          ///< at most 15 characters: "tracker"
  int realtime_priority{0};  ///< 1..99: SCHED_RR, as far as the system permits; 0: SCHED_OTHER
};

/// The calling thread takes the role. A priority above RLIMIT_RTPRIO is cut to it; where none is
/// permitted the thread goes on without, and the log says so.
void take_role(const ThreadRole& role);

}  // namespace handeye
