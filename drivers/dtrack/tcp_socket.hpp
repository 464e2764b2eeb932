// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <netinet/in.h>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>

namespace handeye::dtrack {

/// Until when to wait, and who may end the wait earlier.
struct Patience {
  std::chrono::steady_clock::time_point deadline;
  std::stop_token stop;  ///< noticed within 50 ms
};

enum class TcpResult {
  kDone,
  kFailed,       ///< the system says no; why() tells
  kClosed,       ///< the other side has closed the connection
  kTimedOut,     ///< the deadline has passed
  kInterrupted,  ///< told to stop
};

/// A TCP connection as a client. Never blocks beyond the patience it is given, never throws, raises
/// no SIGPIPE. Closed with the object.
class TcpSocket {
 public:
  TcpSocket();
  TcpSocket(const TcpSocket&) = delete;
  TcpSocket(TcpSocket&&) = delete;
  TcpSocket& operator=(const TcpSocket&) = delete;
  TcpSocket& operator=(TcpSocket&&) = delete;
  ~TcpSocket();

  /// Once in a socket's life: connects to address and port.
  TcpResult connect(const sockaddr_in& address, const Patience& patience);
  /// All of it.
  TcpResult send(std::string_view bytes, const Patience& patience);
  /// Waits for bytes and takes what is there; `count`: how many, 1 or more when kDone.
  TcpResult receive(std::span<char> room, std::size_t& count, const Patience& patience);

  /// After kFailed: the system's reason, in words.
  const std::string& why() const { return why_; }

 private:
  TcpResult fail(int error);
  TcpResult wait_for(short events, const Patience& patience) const;

  int descriptor_;
  std::string why_;
};

}  // namespace handeye::dtrack
