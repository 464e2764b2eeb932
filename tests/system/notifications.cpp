// SPDX-License-Identifier: BSD-3-Clause
#include "tests/system/notifications.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <stdexcept>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "tests/system/process.hpp"

namespace handeye::test {

Notifications::Notifications(const std::filesystem::path& socket_path,
                             std::chrono::microseconds watchdog)
    : descriptor_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = socket_path.string();
  if (name.size() >= sizeof address.sun_path) throw std::runtime_error(name + " is too long");
  std::ranges::copy(name, address.sun_path);
  if (bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    close(descriptor_);
    throw std::runtime_error("cannot bind " + name);
  }
  setenv("NOTIFY_SOCKET", name.c_str(), 1);
  if (watchdog.count() > 0) {
    setenv("WATCHDOG_USEC", std::to_string(watchdog.count()).c_str(), 1);
  }
}

Notifications::~Notifications() {
  unsetenv("NOTIFY_SOCKET");
  unsetenv("WATCHDOG_USEC");
  close(descriptor_);
}

const std::vector<std::string>& Notifications::lines() {
  std::array<char, 4096> text{};
  for (;;) {
    const ssize_t size = recv(descriptor_, text.data(), text.size(), 0);
    if (size < 0) return lines_;
    for (std::string& line : lines_of({text.data(), static_cast<std::size_t>(size)})) {
      lines_.push_back(std::move(line));
    }
  }
}

int Notifications::count(std::string_view beginning) {
  return static_cast<int>(std::ranges::count_if(
      lines(), [&](const std::string& line) { return line.starts_with(beginning); }));
}

void Notifications::forget() {
  lines();
  lines_.clear();
}

}  // namespace handeye::test
