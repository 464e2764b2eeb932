// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <sys/types.h>

namespace handeye::test {

/// The threads of a process, by name; of several with one name the oldest.
std::map<std::string, pid_t> threads_of(pid_t process);

/// Whether the thread waits for something right now. One that has its name waits for work: it has
/// settled what it may.
bool is_waiting(pid_t process, pid_t thread);

/// Holds one thread of a child process still, as a debugger does, and lets it go in the end. The
/// other threads know nothing of it.
class StoppedThread {
 public:
  explicit StoppedThread(pid_t thread);
  ~StoppedThread();
  StoppedThread(const StoppedThread&) = delete;
  StoppedThread& operator=(const StoppedThread&) = delete;

  /// False: this system does not permit it.
  bool is_stopped() const { return stopped_; }

 private:
  pid_t thread_;
  bool stopped_{false};
};

}  // namespace handeye::test
