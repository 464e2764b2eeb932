// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <arpa/inet.h>
#include <array>
#include <cstdint>
#include <netinet/in.h>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include "drivers/dtrack/ipv4.hpp"

namespace handeye::dtrack {

/// The controller's side of a test: a socket bound to a local address.
class UdpSender {
 public:
  explicit UdpSender(const std::string& address = "127.0.0.1")
      : descriptor_(socket(AF_INET, SOCK_DGRAM, 0)) {
    const sockaddr_in local = socket_address(parse_ipv4(address, "test address"), 0);
    if (bind(descriptor_, reinterpret_cast<const sockaddr*>(&local), sizeof local) != 0) {
      throw std::runtime_error("cannot bind to " + address);
    }
    const timeval patience{5, 0};
    setsockopt(descriptor_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  }
  UdpSender(const UdpSender&) = delete;
  UdpSender(UdpSender&&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;
  UdpSender& operator=(UdpSender&&) = delete;
  ~UdpSender() { close(descriptor_); }

  std::uint16_t port() const {
    sockaddr_in local{};
    socklen_t size = sizeof local;
    getsockname(descriptor_, reinterpret_cast<sockaddr*>(&local), &size);
    return ntohs(local.sin_port);
  }

  bool send(std::string_view bytes, std::uint16_t port, const std::string& to = "127.0.0.1") {
    const sockaddr_in target = socket_address(parse_ipv4(to, "test address"), port);
    return sendto(descriptor_, bytes.data(), bytes.size(), 0,
                  reinterpret_cast<const sockaddr*>(&target),
                  sizeof target) == static_cast<ssize_t>(bytes.size());
  }

  /// Through the loopback interface, whatever the routes say.
  bool send_to_loopback_multicast() {
    const in_addr loopback = parse_ipv4("127.0.0.1", "test address");
    return setsockopt(descriptor_, IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof loopback) == 0;
  }

  struct Message {
    std::string text;
    std::uint16_t sender_port{0};
  };
  /// The next message, or nothing within five seconds.
  std::optional<Message> receive() {
    std::array<char, 512> bytes;
    sockaddr_in from{};
    socklen_t size = sizeof from;
    const ssize_t length = recvfrom(descriptor_, bytes.data(), bytes.size(), 0,
                                    reinterpret_cast<sockaddr*>(&from), &size);
    if (length < 0) return std::nullopt;
    return Message{{bytes.data(), static_cast<std::size_t>(length)}, ntohs(from.sin_port)};
  }

 private:
  int descriptor_;
};

}  // namespace handeye::dtrack
