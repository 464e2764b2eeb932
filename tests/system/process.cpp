// SPDX-License-Identifier: BSD-3-Clause
#include "tests/system/process.hpp"

#include <csignal>
#include <fcntl.h>
#include <spawn.h>
#include <sstream>
#include <stdexcept>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace handeye::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

std::string program(const char* name) {
  return std::string(HANDEYE_PROGRAMS) + "/" + name;
}

}  // namespace

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

Process::Process(const std::vector<std::string>& words) {
  // posix_spawn cannot ask for the parent's death signal; setpriv does, then becomes the program.
  std::vector<std::string> all{"setpriv", "--pdeathsig", "KILL", "--"};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> argv;
  argv.reserve(all.size() + 1);
  for (std::string& word : all) argv.push_back(word.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  const auto catch_in = [&](int descriptor, const char* name) {
    posix_spawn_file_actions_addopen(&files, descriptor, (folder_ / name).c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, 0600);
  };
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  catch_in(STDOUT_FILENO, "out");
  catch_in(STDERR_FILENO, "err");
  const int error = posix_spawnp(&process_, argv[0], &files, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) throw std::runtime_error("cannot start setpriv (util-linux) for " + words.at(0));
}

Process::~Process() {
  if (has_ended()) return;
  kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
}

void Process::send_signal(int signal) const {
  if (process_ > 0) kill(process_, signal);
}

bool Process::has_ended() {
  if (process_ < 0) return true;
  int status = 0;
  if (waitpid(process_, &status, WNOHANG) != process_) return false;
  process_ = -1;
  exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return true;
}

std::optional<Finished> Process::wait(milliseconds timeout) {
  const auto deadline = steady_clock::now() + timeout;
  while (!has_ended()) {
    if (steady_clock::now() > deadline) return std::nullopt;
    std::this_thread::sleep_for(milliseconds(5));
  }
  return Finished{exit_code_, out(), err()};
}

Finished run(const std::vector<std::string>& words, milliseconds timeout) {
  Process process(words);
  if (auto finished = process.wait(timeout)) return *finished;
  return {-1, process.out(), process.err() + "\n(killed after the test's time-out)"};
}

std::string handeyed() {
  return program("handeyed");
}

std::string handeye() {
  return program("handeye");
}

std::string handeye_sim() {
  return program("handeye-sim");
}

}  // namespace handeye::test
