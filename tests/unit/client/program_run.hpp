// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <sys/types.h>
#include <vector>

namespace handeye::test {

/// A folder that goes with the test.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// How a program ended.
struct Finished {
  int exit_code{-1};  ///< -1: ended by a signal
  std::string out;
  std::string err;
};

/// The program `handeye` in a process of its own, its output caught in files.
class ProgramRun {
 public:
  explicit ProgramRun(const std::vector<std::string>& arguments);
  /// Ends the program if it still runs.
  ~ProgramRun();
  ProgramRun(const ProgramRun&) = delete;
  ProgramRun& operator=(const ProgramRun&) = delete;

  /// What Ctrl-C does.
  void interrupt() const;
  Finished wait();

 private:
  TemporaryFolder folder_;
  pid_t process_{-1};
};

Finished run_handeye(const std::vector<std::string>& arguments);

std::string read_text(const std::filesystem::path& file);
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace handeye::test
