// SPDX-License-Identifier: BSD-3-Clause
#include "tests/system/reserved_port.hpp"

#include <algorithm>
#include <cstddef>
#include <netinet/in.h>
#include <stdexcept>
#include <string>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace handeye::test {
namespace {

/// An abstract Unix socket named after the port: the kernel lets one process at a time have the
/// name, and forgets it with the process. -1: another test has it.
int reserve(std::uint16_t port) {
  const int descriptor = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const std::string name = "handeye-test-port-" + std::to_string(port);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::ranges::copy(name, address.sun_path + 1);
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  if (bind(descriptor, reinterpret_cast<const sockaddr*>(&address), size) == 0) return descriptor;
  close(descriptor);
  return -1;
}

}  // namespace

ReservedPort::ReservedPort() {
  constexpr int kAttempts = 100;
  for (int attempt = 0; attempt < kAttempts && reservation_ < 0; ++attempt) {
    number_ = OccupiedPort().number();
    reservation_ = reserve(number_);
  }
  if (reservation_ < 0) throw std::runtime_error("no free UDP port");
}

ReservedPort::~ReservedPort() {
  close(reservation_);
}

OccupiedPort::OccupiedPort() : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  if (bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    close(socket_);
    throw std::runtime_error("no UDP port can be bound");
  }
}

OccupiedPort::~OccupiedPort() {
  close(socket_);
}

std::uint16_t OccupiedPort::number() const {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
  return ntohs(address.sin_port);
}

}  // namespace handeye::test
