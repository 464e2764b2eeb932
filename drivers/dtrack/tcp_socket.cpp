// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dtrack/tcp_socket.hpp"

#include <algorithm>
#include <cerrno>
#include <poll.h>
#include <sys/socket.h>
#include <system_error>
#include <unistd.h>

namespace handeye::dtrack {
namespace {

using std::chrono::milliseconds;

/// How long a request to stop may go unnoticed.
constexpr milliseconds kLongestWait{50};

}  // namespace

TcpSocket::TcpSocket()
    : descriptor_(socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
  if (descriptor_ < 0) fail(errno);
}

TcpSocket::~TcpSocket() {
  if (descriptor_ >= 0) close(descriptor_);
}

TcpResult TcpSocket::connect(const sockaddr_in& address, const Patience& patience) {
  if (descriptor_ < 0) return TcpResult::kFailed;
  if (::connect(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
    return TcpResult::kDone;
  }
  // An interrupted connect goes on, too.
  if (errno != EINPROGRESS && errno != EINTR) return fail(errno);
  const TcpResult waited = wait_for(POLLOUT, patience);
  if (waited != TcpResult::kDone) return waited;
  int error = 0;
  socklen_t size = sizeof error;
  if (getsockopt(descriptor_, SOL_SOCKET, SO_ERROR, &error, &size) != 0) return fail(errno);
  return error == 0 ? TcpResult::kDone : fail(error);
}

TcpResult TcpSocket::send(std::string_view bytes, const Patience& patience) {
  while (!bytes.empty()) {
    const TcpResult waited = wait_for(POLLOUT, patience);
    if (waited != TcpResult::kDone) return waited;
    const ssize_t sent = ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    } else if (errno == EPIPE || errno == ECONNRESET) {
      return TcpResult::kClosed;
    } else if (errno != EAGAIN && errno != EINTR) {
      return fail(errno);
    }
  }
  return TcpResult::kDone;
}

TcpResult TcpSocket::receive(std::span<char> room, std::size_t& count, const Patience& patience) {
  while (true) {
    const TcpResult waited = wait_for(POLLIN, patience);
    if (waited != TcpResult::kDone) return waited;
    const ssize_t received = recv(descriptor_, room.data(), room.size(), 0);
    if (received > 0) {
      count = static_cast<std::size_t>(received);
      return TcpResult::kDone;
    }
    if (received == 0 || errno == ECONNRESET) return TcpResult::kClosed;
    if (errno != EAGAIN && errno != EINTR) return fail(errno);
  }
}

TcpResult TcpSocket::fail(int error) {
  why_ = std::generic_category().message(error);
  return TcpResult::kFailed;
}

/// Errors and hang-ups are kDone as well: the call that follows says which.
TcpResult TcpSocket::wait_for(short events, const Patience& patience) const {
  while (true) {
    if (patience.stop.stop_requested()) return TcpResult::kInterrupted;
    const auto left =
        std::chrono::ceil<milliseconds>(patience.deadline - std::chrono::steady_clock::now());
    const milliseconds wait = std::clamp(left, milliseconds(0), kLongestWait);
    pollfd descriptor{.fd = descriptor_, .events = events, .revents = 0};
    if (poll(&descriptor, 1, static_cast<int>(wait.count())) > 0) return TcpResult::kDone;
    if (left <= milliseconds(0)) return TcpResult::kTimedOut;
  }
}

}  // namespace handeye::dtrack
