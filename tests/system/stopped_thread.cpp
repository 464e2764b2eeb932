// SPDX-License-Identifier: BSD-3-Clause
#include "tests/system/stopped_thread.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sys/ptrace.h>
#include <sys/wait.h>

namespace handeye::test {

std::map<std::string, pid_t> threads_of(pid_t process) {
  std::map<std::string, pid_t> threads;
  const auto tasks = "/proc/" + std::to_string(process) + "/task";
  for (const auto& task : std::filesystem::directory_iterator(tasks)) {
    std::string name;
    std::getline(std::ifstream(task.path() / "comm"), name);
    const auto id = static_cast<pid_t>(std::stol(task.path().filename().string()));
    const auto [found, is_new] = threads.try_emplace(name, id);
    // A thread's own threads, a library's, bear its name at first.
    if (!is_new) found->second = std::min(found->second, id);
  }
  return threads;
}

bool is_waiting(pid_t process, pid_t thread) {
  std::ifstream file("/proc/" + std::to_string(process) + "/task/" + std::to_string(thread) +
                     "/status");
  const std::string sleeping = "State:\tS";
  for (std::string line; std::getline(file, line);) {
    if (line.compare(0, sleeping.size(), sleeping) == 0) return true;
  }
  return false;
}

StoppedThread::StoppedThread(pid_t thread) : thread_(thread) {
  if (ptrace(PTRACE_SEIZE, thread, nullptr, nullptr) != 0) return;
  stopped_ = ptrace(PTRACE_INTERRUPT, thread, nullptr, nullptr) == 0 &&
             waitpid(thread, nullptr, __WALL) == thread;
}

StoppedThread::~StoppedThread() {
  if (stopped_) ptrace(PTRACE_DETACH, thread_, nullptr, nullptr);
}

}  // namespace handeye::test
