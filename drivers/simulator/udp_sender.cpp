// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/udp_sender.hpp"

#include <cerrno>
#include <cstring>
#include <memory>
#include <netdb.h>
#include <unistd.h>

#include <fmt/format.h>

#include "protocol/exit_codes.hpp"

namespace handeye::simulator {

UdpSender::UdpSender(const std::string& host, std::uint16_t port) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
  if (error != 0) {
    throw InputError(fmt::format("tracker host '{}': {}; give a name or address that is known here",
                                 host, gai_strerror(error)));
  }
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> addresses(found, &freeaddrinfo);
  std::memcpy(&address_, addresses->ai_addr, addresses->ai_addrlen);
  address_size_ = addresses->ai_addrlen;
  socket_ = socket(addresses->ai_family, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket_ < 0) {
    throw InputError(fmt::format("tracker host '{}': no socket ({}); free some descriptors", host,
                                 std::strerror(errno)));
  }
}

UdpSender::~UdpSender() {
  if (socket_ >= 0) close(socket_);
}

bool UdpSender::send(std::string_view datagram) const {
  // Not connected, so that a port where nobody listens yet is no error.
  const ssize_t sent = sendto(socket_, datagram.data(), datagram.size(), MSG_NOSIGNAL,
                              reinterpret_cast<const sockaddr*>(&address_), address_size_);
  return sent == static_cast<ssize_t>(datagram.size());
}

}  // namespace handeye::simulator
