// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/controller.hpp"

#include <arpa/inet.h>
#include <array>
#include <cerrno>
#include <cstring>
#include <netinet/in.h>
#include <poll.h>
#include <string_view>
#include <sys/socket.h>
#include <unistd.h>

#include <fmt/format.h>

#include "drivers/dtrack/ipv4.hpp"
#include "protocol/bus.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye::simulator {
namespace {

constexpr int kWait_ms = 20;
constexpr std::size_t kMostClients = 16;
/// The real one's limit is not known; the vendor's own programs send 200 bytes at most.
constexpr std::size_t kLongestCommand = 1024;
constexpr std::int64_t kDripPeriod_ns = 250'000'000;
constexpr std::string_view kGarbage("220 mail.example.org ESMTP\r\n\0", 29);
/// Who has the control with kBusy: an address that is kept for examples.
constexpr std::string_view kOtherOwner = "192.0.2.7";

int listen_on(const sockaddr_in& address, const std::string& where) {
  const int descriptor = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const int on = 1;
  // A port whose last connections are still dying can be listened on again.
  if (descriptor >= 0 && setsockopt(descriptor, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) == 0 &&
      bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 &&
      listen(descriptor, static_cast<int>(kMostClients)) == 0) {
    return descriptor;
  }
  const int error = errno;
  if (descriptor >= 0) close(descriptor);
  throw InputError(fmt::format("controller: cannot listen on TCP port {}: {}; choose another one",
                               where, std::strerror(error)));
}

bool send_all(int descriptor, std::string_view bytes) {
  return send(descriptor, bytes.data(), bytes.size(), MSG_NOSIGNAL) ==
         static_cast<ssize_t>(bytes.size());
}

}  // namespace

Controller::Controller(const ControllerOptions& options) : options_(options) {
  sockaddr_in address = dtrack::socket_address(
      dtrack::parse_ipv4(options.bind_address, "controller address"), options.port);
  listener_ = listen_on(address, fmt::format("{}:{}", options.bind_address, options.port));
  socklen_t size = sizeof address;
  getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
  port_ = ntohs(address.sin_port);
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

Controller::~Controller() {
  thread_.request_stop();
  thread_.join();
  for (const Client& client : clients_) close(client.descriptor);
  close(listener_);
}

void Controller::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    wait_for_work();
    accept_client();
    for (auto client = clients_.begin(); client != clients_.end();) {
      if (serve(*client)) {
        ++client;
      } else {
        close(client->descriptor);
        client = clients_.erase(client);
      }
    }
  }
}

void Controller::wait_for_work() {
  std::vector<pollfd> waited_for{{listener_, POLLIN, 0}};
  for (const Client& client : clients_) waited_for.push_back({client.descriptor, POLLIN, 0});
  poll(waited_for.data(), waited_for.size(), kWait_ms);
}

void Controller::accept_client() {
  sockaddr_in from{};
  socklen_t size = sizeof from;
  const int descriptor =
      accept4(listener_, reinterpret_cast<sockaddr*>(&from), &size, SOCK_NONBLOCK | SOCK_CLOEXEC);
  if (descriptor < 0) return;
  if (options_.fault == ControllerFault::kRefuse || clients_.size() == kMostClients) {
    close(descriptor);
    return;
  }
  std::array<char, INET_ADDRSTRLEN> address{};
  inet_ntop(AF_INET, &from.sin_addr, address.data(), address.size());
  clients_.push_back({.descriptor = descriptor, .address = address.data(), .received = {}});
}

bool Controller::serve(Client& client) {
  std::array<char, 512> room;
  const ssize_t count = recv(client.descriptor, room.data(), room.size(), 0);
  if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) return false;
  if (count > 0) client.received.append(room.data(), static_cast<std::size_t>(count));
  for (std::size_t end = client.received.find('\0'); end != std::string::npos;
       end = client.received.find('\0')) {
    const std::string command = client.received.substr(0, end);
    client.received.erase(0, end + 1);
    if (!answer(client, command)) return false;
  }
  return client.received.size() <= kLongestCommand && drip(client);
}

bool Controller::answer(Client& client, const std::string& command) {
  const bool busy = options_.fault == ControllerFault::kBusy;
  const bool first = client.descriptor == clients_.front().descriptor;
  const std::string_view owner = busy ? kOtherOwner : std::string_view(clients_.front().address);
  const auto reply = [&] { return answers_.answer(command, first && !busy, owner) + '\0'; };
  if (!options_.fault || busy) return send_all(client.descriptor, reply());
  switch (*options_.fault) {
    case ControllerFault::kSlow:
      for (const char byte : reply()) client.waiting.push_back(byte);
      return true;
    case ControllerFault::kGarbage:
      return send_all(client.descriptor, kGarbage);
    case ControllerFault::kError:
      return send_all(client.descriptor,
                      std::string_view("dtrack2 err 99 \"internal error\"\0", 32));
    default:
      return true;
  }
}

bool Controller::drip(Client& client) {
  const std::int64_t now_ns = monotonic_ns();
  if (client.waiting.empty() || now_ns < client.next_byte_ns) return true;
  client.next_byte_ns = now_ns + kDripPeriod_ns;
  const char byte = client.waiting.front();
  client.waiting.pop_front();
  return send_all(client.descriptor, {&byte, 1});
}

}  // namespace handeye::simulator
