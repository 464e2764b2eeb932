// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

#include "tests/unit/recording/temporary_folder.hpp"

namespace handeye::test {

/// How a program ended, and what it said.
struct Finished {
  int exit_code{-1};  ///< -1: ended by a signal, or had to be killed
  std::string out;
  std::string err;
};

/// The lines of a text, without their ends.
std::vector<std::string> lines_of(const std::string& text);

/// A program in a process of its own, its output caught in files. It never outlives the test: the
/// destructor kills it, and so does the kernel should the test itself die.
class Process {
 public:
  /// `words`: the program (an absolute path, or found in PATH) and its arguments. Throws
  /// std::runtime_error when it cannot be started.
  explicit Process(const std::vector<std::string>& words);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  pid_t id() const { return process_; }
  void send_signal(int signal) const;
  /// Does not wait.
  bool has_ended();
  /// Waits; nothing when it still runs after `timeout`. Its output is there in either case.
  std::optional<Finished> wait(std::chrono::milliseconds timeout);

  std::string out() const { return read_bytes(folder_ / "out"); }
  std::string err() const { return read_bytes(folder_ / "err"); }

 private:
  TemporaryFolder folder_;
  pid_t process_{-1};  ///< -1: it has ended and been waited for
  int exit_code_{-1};
};

/// Runs a program to its end; one that takes longer than `timeout` is killed, exit code -1.
Finished run(const std::vector<std::string>& words,
             std::chrono::milliseconds timeout = std::chrono::seconds(120));

/// The programs under test, as they were built.
std::string handeyed();
std::string handeye();
std::string handeye_sim();

}  // namespace handeye::test
