// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "drivers/dtrack/receiver.hpp"

namespace handeye::dtrack {

/// A bound, non-blocking UDP socket that stamps what it receives and counts what it drops. Its own,
/// or one that was passed to the program; closed with the object.
class UdpSocket {
 public:
  /// Throws UsageError or InputError as Receiver does.
  explicit UdpSocket(const ReceiverOptions& options);
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket(UdpSocket&&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;
  UdpSocket& operator=(UdpSocket&&) = delete;
  ~UdpSocket();

  int descriptor() const { return descriptor_; }
  std::uint16_t port() const;  ///< the one it is bound to
  /// Datagrams that waited in a passed socket: they came when nobody listened, and are gone.
  std::uint64_t stale() const { return stale_; }

 private:
  void set_up(const ReceiverOptions& options);
  void bind_to(const ReceiverOptions& options);
  void join(const ReceiverOptions& options);
  void take_over();

  int descriptor_;
  std::uint64_t stale_{0};
};

}  // namespace handeye::dtrack
