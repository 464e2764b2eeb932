// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <sys/socket.h>

namespace handeye::simulator {

/// Sends datagrams to one address and does not care who listens, like a tracker's controller.
class UdpSender {
 public:
  /// Throws InputError when the host is not known or no socket can be had.
  UdpSender(const std::string& host, std::uint16_t port);
  ~UdpSender();
  UdpSender(const UdpSender&) = delete;
  UdpSender& operator=(const UdpSender&) = delete;

  /// False: the network did not take it.
  bool send(std::string_view datagram) const;

 private:
  int socket_{-1};
  sockaddr_storage address_{};
  socklen_t address_size_{0};
};

}  // namespace handeye::simulator
