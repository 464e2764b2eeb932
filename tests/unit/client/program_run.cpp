// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/client/program_run.hpp"

#include <fcntl.h>
#include <fstream>
#include <signal.h>
#include <spawn.h>
#include <sstream>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>

namespace handeye::test {

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "handeye-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

ProgramRun::ProgramRun(const std::vector<std::string>& arguments) {
  std::vector<std::string> words{HANDEYE_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  const auto catch_in = [&](int descriptor, const std::string& name) {
    posix_spawn_file_actions_addopen(&files, descriptor, (folder_ / name).c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, 0600);
  };
  catch_in(STDOUT_FILENO, "out");
  catch_in(STDERR_FILENO, "err");
  const int error = posix_spawn(&process_, argv[0], &files, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) throw std::runtime_error("cannot start " HANDEYE_PROGRAM);
}

ProgramRun::~ProgramRun() {
  if (process_ < 0) return;
  kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
}

void ProgramRun::interrupt() const {
  kill(process_, SIGINT);
}

Finished ProgramRun::wait() {
  int status = 0;
  waitpid(process_, &status, 0);
  process_ = -1;
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(folder_ / "out"),
          read_text(folder_ / "err")};
}

Finished run_handeye(const std::vector<std::string>& arguments) {
  return ProgramRun(arguments).wait();
}

std::string read_text(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file) << text;
}

}  // namespace handeye::test
