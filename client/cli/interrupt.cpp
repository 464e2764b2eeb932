// SPDX-License-Identifier: BSD-3-Clause
#include "client/cli/interrupt.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <poll.h>
#include <signal.h>
#include <string>
#include <sys/signalfd.h>
#include <unistd.h>

#include "protocol/exit_codes.hpp"

namespace handeye::cli {
namespace {

sigset_t ending_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  return set;
}

}  // namespace

Interrupt::Interrupt() {
  const sigset_t set = ending_signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  signals_ = signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
  if (signals_ < 0) {
    throw InputError(std::string("no descriptor for signals: ") + std::strerror(errno));
  }
}

Interrupt::~Interrupt() {
  close(signals_);
  const sigset_t set = ending_signals();
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

bool Interrupt::wait(int file_descriptor, std::chrono::milliseconds timeout) {
  std::array<pollfd, 2> waiting{pollfd{file_descriptor, POLLIN, 0}, pollfd{signals_, POLLIN, 0}};
  poll(waiting.data(), waiting.size(), static_cast<int>(timeout.count()));
  signalfd_siginfo signal{};
  return read(signals_, &signal, sizeof signal) == static_cast<ssize_t>(sizeof signal);
}

}  // namespace handeye::cli
