// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/thread_role.hpp"

#include <algorithm>
#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <system_error>

#include <spdlog/spdlog.h>

namespace handeye {
namespace {

/// 0, or the error.
int set_scheduling(int policy, int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  return pthread_setschedparam(pthread_self(), policy, &parameters);
}

int permitted_priority() {
  rlimit limit{};
  if (getrlimit(RLIMIT_RTPRIO, &limit) != 0) return 0;
  return static_cast<int>(std::min<rlim_t>(limit.rlim_cur, 99));
}

}  // namespace

void take_role(const ThreadRole& role) {
  pthread_setname_np(pthread_self(), role.name.c_str());
  if (role.realtime_priority == 0) {
    // Explicitly: the service may have been started with a real-time priority.
    set_scheduling(SCHED_OTHER, 0);
    return;
  }
  int error = set_scheduling(SCHED_RR, role.realtime_priority);
  const int permitted = std::min(role.realtime_priority, permitted_priority());
  if (error != 0 && permitted > 0) error = set_scheduling(SCHED_RR, permitted);
  if (error == 0) return;
  set_scheduling(SCHED_OTHER, 0);
  spdlog::info("{}: no real-time priority ({}): it may be late on a busy machine", role.name,
               std::generic_category().message(error));
}

}  // namespace handeye
