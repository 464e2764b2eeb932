// SPDX-License-Identifier: BSD-3-Clause
#include "protocol/bus.hpp"

#include <arpa/inet.h>
#include <cerrno>
#include <cstdlib>
#include <ctime>
#include <limits>
#include <netinet/in.h>
#include <optional>
#include <poll.h>
#include <random>
#include <string_view>
#include <sys/socket.h>
#include <unistd.h>

#include "protocol/channels.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye {
namespace {

std::int64_t clock_ns(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

/// The multicast group of a "udpm://group:port?..." URL; nothing for other providers.
std::optional<sockaddr_in> multicast_group(const std::string& url) {
  constexpr std::string_view kScheme = "udpm://";
  if (!url.starts_with(kScheme)) return std::nullopt;
  const std::string authority = url.substr(kScheme.size(), url.find('?') - kScheme.size());
  const std::size_t colon = authority.find(':');
  const std::string group = authority.empty() ? "239.255.76.67" : authority.substr(0, colon);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(7667);
  if (colon != std::string::npos) {
    const int port = std::atoi(authority.c_str() + colon + 1);
    if (port < 1 || port > 65535) {
      throw InputError("LCM provider '" + url + "': the port must be 1..65535");
    }
    address.sin_port = htons(static_cast<std::uint16_t>(port));
  }
  if (inet_pton(AF_INET, group.c_str(), &address.sin_addr) != 1 ||
      !IN_MULTICAST(ntohl(address.sin_addr.s_addr))) {
    throw InputError("LCM provider '" + url + "': '" + group +
                     "' is not a multicast address (224.0.0.0 to 239.255.255.255)");
  }
  return address;
}

/// LCM itself would print a line of its own about a scheme it does not know.
void require_known_scheme(const std::string& url) {
  for (const std::string_view scheme : {"udpm://", "memq://", "tcpq://", "file://"}) {
    if (url.starts_with(scheme)) return;
  }
  throw InputError("LCM provider '" + url + "': must begin with udpm://, for example " +
                   std::string(kDefaultLcmProvider));
}

/// LCM itself would print a screenful, part of it garbage; so ask the kernel first.
void require_multicast_route(const sockaddr_in& group) {
  const int probe = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (probe < 0) return;
  const int result = connect(probe, reinterpret_cast<const sockaddr*>(&group), sizeof group);
  const int error = errno;
  close(probe);
  if (result != 0 && error == ENETUNREACH) {
    throw InputError(
        "no network route for LCM's multicast messages; to keep them on this machine run: "
        "sudo ip route replace 239.255.0.0/16 dev lo src 127.0.0.1");
  }
}

}  // namespace

std::int64_t realtime_us() {
  return clock_ns(CLOCK_REALTIME) / 1000;
}

std::int64_t monotonic_ns() {
  return clock_ns(CLOCK_MONOTONIC);
}

std::int64_t random_id() {
  std::random_device device;
  std::uniform_int_distribution<std::int64_t> draw(1, std::numeric_limits<std::int64_t>::max());
  return draw(device);
}

Bus::Bus(const std::string& provider_url) : session_id_(random_id()) {
  require_known_scheme(provider_url);
  if (const auto group = multicast_group(provider_url)) require_multicast_route(*group);
  lcm_ = std::make_unique<lcm::LCM>(provider_url);
  if (!lcm_->good()) {
    throw InputError("LCM cannot use the provider '" + provider_url +
                     "': check the URL and the network (ip route)");
  }
}

Bus::~Bus() = default;

void Bus::subscribe_raw(const std::string& channel, RawHandler handler) {
  handlers_.push_back(std::make_unique<RawHandler>(std::move(handler)));
  const auto deliver = [](const lcm::ReceiveBuffer* buffer, const std::string&,
                          RawHandler* raw_handler) {
    (*raw_handler)(buffer->data, buffer->data_size);
  };
  lcm::Subscription* subscription =
      lcm_->subscribeFunction<RawHandler*>(channel, deliver, handlers_.back().get());
  if (subscription == nullptr) {
    throw InputError(
        "LCM cannot receive on channel " + channel +
        ": its self-test heard nothing; does a firewall block multicast on this host?");
  }
  // A burst of large frames must not push out a request: LCM drops the newest when full.
  subscription->setQueueCapacity(256);
}

bool Bus::handle(std::chrono::milliseconds timeout) {
  pollfd waiting{file_descriptor(), POLLIN, 0};
  if (poll(&waiting, 1, static_cast<int>(timeout.count())) <= 0) return false;
  return lcm_->handle() == 0;
}

int Bus::file_descriptor() const {
  return lcm_->getFileno();
}

}  // namespace handeye
