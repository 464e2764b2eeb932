// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <arpa/inet.h>
#include <array>
#include <cstdint>
#include <functional>
#include <netinet/in.h>
#include <optional>
#include <poll.h>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <string_view>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

namespace handeye::dtrack {

/// A TCP port of the loopback that listens, or with a backlog of nothing one that is taken and
/// refuses. Nothing is accepted unless asked for.
class ListeningPort {
 public:
  explicit ListeningPort(std::optional<int> backlog = 8)
      : descriptor_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), size) != 0 ||
        (backlog && listen(descriptor_, *backlog) != 0) ||
        getsockname(descriptor_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
      throw std::runtime_error("no TCP port");
    }
    address_ = address;
  }
  ListeningPort(const ListeningPort&) = delete;
  ListeningPort& operator=(const ListeningPort&) = delete;
  ~ListeningPort() { close(descriptor_); }

  std::uint16_t port() const { return ntohs(address_.sin_port); }
  int descriptor() const { return descriptor_; }
  const sockaddr_in& address() const { return address_; }

 private:
  int descriptor_;
  sockaddr_in address_{};
};

/// Drops whatever is sent to it, as a firewall does: its queue of one is full, so that the kernel
/// answers no further knock.
class BlackHole {
 public:
  BlackHole() {
    for (int& filler : fillers_) {
      filler = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0);
      connect(filler, reinterpret_cast<const sockaddr*>(&port_.address()), sizeof(sockaddr_in));
    }
    pollfd first{fillers_[0], POLLOUT, 0};
    poll(&first, 1, 5000);
  }
  BlackHole(const BlackHole&) = delete;
  BlackHole& operator=(const BlackHole&) = delete;
  ~BlackHole() {
    for (const int filler : fillers_) close(filler);
  }

  std::uint16_t port() const { return port_.port(); }

 private:
  ListeningPort port_{0};
  std::array<int, 2> fillers_{};
};

/// The controller's end of one connection.
class Peer {
 public:
  Peer(int descriptor, std::stop_token stop) : descriptor_(descriptor), stop_(std::move(stop)) {}
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  ~Peer() { close(descriptor_); }

  /// The next command without its NUL; nothing once the other side has closed.
  std::optional<std::string> command() {
    std::string text;
    while (const auto byte = next_byte()) {
      if (*byte == '\0') return text;
      text += *byte;
    }
    return std::nullopt;
  }

  /// False: the other side has gone.
  bool write(std::string_view bytes) {
    return send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL) ==
           static_cast<ssize_t>(bytes.size());
  }
  /// With its NUL.
  bool answer(std::string_view text) { return write(std::string(text) + '\0'); }

  /// Until the other side closes, or the test ends.
  void wait_for_the_end() {
    while (next_byte()) {
    }
  }

  const std::stop_token& stop() const { return stop_; }

 private:
  std::optional<char> next_byte() {
    while (!stop_.stop_requested()) {
      pollfd waited_for{descriptor_, POLLIN, 0};
      if (poll(&waited_for, 1, 20) <= 0) continue;
      char byte = 0;
      if (recv(descriptor_, &byte, 1, 0) != 1) return std::nullopt;
      return byte;
    }
    return std::nullopt;
  }

  int descriptor_;
  std::stop_token stop_;
};

/// A controller that does as the test says with every connection, one after the other.
class ScriptedController {
 public:
  explicit ScriptedController(std::function<void(Peer&)> script)
      : thread_([this, script = std::move(script)](const std::stop_token& stop) {
          while (!stop.stop_requested()) {
            pollfd waited_for{port_.descriptor(), POLLIN, 0};
            if (poll(&waited_for, 1, 20) <= 0) continue;
            const int descriptor = accept(port_.descriptor(), nullptr, nullptr);
            if (descriptor < 0) continue;
            Peer peer(descriptor, stop);
            script(peer);
          }
        }) {}

  std::uint16_t port() const { return port_.port(); }

 private:
  ListeningPort port_;
  std::jthread thread_;
};

}  // namespace handeye::dtrack
