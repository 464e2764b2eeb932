// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dtrack/udp_socket.hpp"

#include <cerrno>
#include <fcntl.h>
#include <net/if.h>
#include <sys/socket.h>
#include <system_error>
#include <unistd.h>

#include "drivers/dtrack/ipv4.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye::dtrack {
namespace {

/// Of the system's last error, in words.
std::string why() {
  return std::generic_category().message(errno);
}

bool set_option(int descriptor, int level, int option, int value) {
  return setsockopt(descriptor, level, option, &value, sizeof value) == 0;
}

}  // namespace

UdpSocket::UdpSocket(const ReceiverOptions& options)
    : descriptor_(options.passed_descriptor
                      ? *options.passed_descriptor
                      : socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
  if (descriptor_ < 0) throw InputError("tracker: cannot open a UDP socket: " + why());
  try {
    set_up(options);
    if (!options.passed_descriptor) bind_to(options);
    if (!options.multicast_group.empty()) join(options);
    if (options.passed_descriptor) take_over();
  } catch (...) {
    close(descriptor_);
    throw;
  }
}

UdpSocket::~UdpSocket() {
  close(descriptor_);
}

std::uint16_t UdpSocket::port() const {
  sockaddr_in bound{};
  socklen_t size = sizeof bound;
  getsockname(descriptor_, reinterpret_cast<sockaddr*>(&bound), &size);
  return ntohs(bound.sin_port);
}

void UdpSocket::set_up(const ReceiverOptions& options) {
  // Without stamps arrival is when we look, without the count drops show as gaps in `fr` only, with
  // a smaller buffer drops are likelier: none of these is a reason not to run.
  set_option(descriptor_, SOL_SOCKET, SO_TIMESTAMPNS, 1);
  set_option(descriptor_, SOL_SOCKET, SO_RXQ_OVFL, 1);
  set_option(descriptor_, SOL_SOCKET, SO_RCVBUF, options.receive_buffer_bytes);
  if (!options.multicast_group.empty()) {
    // Other programs may listen to the group too; groups they join on this machine are not ours.
    set_option(descriptor_, SOL_SOCKET, SO_REUSEADDR, 1);
    set_option(descriptor_, IPPROTO_IP, IP_MULTICAST_ALL, 0);
  }
  if (options.interface.empty()) return;
  if (if_nametoindex(options.interface.c_str()) == 0) {
    throw UsageError("tracker: there is no network interface '" + options.interface +
                     "': `ip link` lists them");
  }
  if (setsockopt(descriptor_, SOL_SOCKET, SO_BINDTODEVICE, options.interface.c_str(),
                 static_cast<socklen_t>(options.interface.size())) != 0) {
    throw InputError("tracker: cannot listen on interface " + options.interface + ": " + why());
  }
}

void UdpSocket::bind_to(const ReceiverOptions& options) {
  in_addr local{INADDR_ANY};
  if (!options.bind_address.empty()) local = parse_ipv4(options.bind_address, "bind address");
  const sockaddr_in address = socket_address(local, options.port);
  if (bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) return;

  const std::string port = "tracker: UDP port " + std::to_string(options.port);
  if (errno == EADDRINUSE) {
    throw InputError(port + " is in use by another program: stop that, or choose another port");
  }
  throw InputError(port + " cannot be opened" +
                   (options.bind_address.empty() ? "" : " on " + options.bind_address) + ": " +
                   why());
}

/// Empties the queue: whatever is in it came before. The kernel's stamps cannot tell, for it stamps
/// only what arrives after somebody has asked for stamps.
void UdpSocket::take_over() {
  constexpr std::uint64_t kMostWaiting = 1'000'000;  // a flood must not hold us here
  fcntl(descriptor_, F_SETFL, fcntl(descriptor_, F_GETFL) | O_NONBLOCK);
  fcntl(descriptor_, F_SETFD, FD_CLOEXEC);
  char byte = 0;
  while (stale_ < kMostWaiting && recv(descriptor_, &byte, sizeof byte, MSG_DONTWAIT) >= 0) {
    ++stale_;
  }
}

void UdpSocket::join(const ReceiverOptions& options) {
  ip_mreqn membership{};
  membership.imr_multiaddr = parse_ipv4(options.multicast_group, "multicast group");
  if (!IN_MULTICAST(ntohl(membership.imr_multiaddr.s_addr))) {
    throw UsageError("tracker: " + options.multicast_group +
                     " is no multicast group: they run from 224.0.1.0 to 239.255.255.255");
  }
  // A named interface comes first; else the one that has the address listened on; else the route's.
  if (!options.interface.empty()) {
    membership.imr_ifindex = static_cast<int>(if_nametoindex(options.interface.c_str()));
  } else if (!options.bind_address.empty()) {
    membership.imr_address = parse_ipv4(options.bind_address, "bind address");
  }
  if (setsockopt(descriptor_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) == 0) {
    return;
  }
  throw InputError("tracker: cannot join multicast group " + options.multicast_group + ": " +
                   why() + "; name the interface, or add a route to 224.0.0.0/4");
}

}  // namespace handeye::dtrack
