// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "drivers/datagram.hpp"

namespace handeye::dtrack {

/// Addresses are IPv4 in dotted form; an empty text means "none" or "any".
struct ReceiverOptions {
  std::uint16_t port{5000};        ///< 0: any free one, see Receiver::port()
  std::string bind_address;        ///< local address to listen on; empty: all
  std::string interface;           ///< e.g. "eth1": listen and join there only; empty: all
  std::string multicast_group;     ///< e.g. "239.255.0.7"; empty: unicast only
  std::string source_address;      ///< accept datagrams of this controller only; empty: of all
  std::string controller_address;  ///< where to send the firewall opener; empty: nowhere
  std::uint16_t controller_port{50107};
  std::chrono::milliseconds opener_silence{5'000};  ///< sent again after so long without data
  int receive_buffer_bytes{4 << 20};                ///< asked of the kernel, which may grant less
  /// A bound UDP socket of IPv4 that is taken over, and closed in the end, instead of opening one:
  /// systemd's. Port and bind address are then its own. Nothing: one is opened.
  std::optional<int> passed_descriptor;
};

/// Counted since construction.
struct ReceiverCounters {
  std::uint64_t received{0};        ///< handed out
  std::uint64_t bytes{0};           ///< of those handed out
  std::uint64_t ignored_source{0};  ///< from another address than `source_address`
  std::uint64_t empty{0};           ///< zero-length
  std::uint64_t kernel_drops{0};    ///< the socket's buffer was full
  std::uint64_t stale{0};           ///< waited in a passed socket from before it was taken over
  std::uint64_t socket_errors{0};   ///< failed receive calls, e.g. while the network is down
  std::uint64_t openers_sent{0};    ///< firewall openers
};

/// The UDP socket the tracker sends to. One thread uses it.
///
/// Arrival times are the kernel's, converted to CLOCK_MONOTONIC as arrival_clock.hpp tells.
class Receiver {
 public:
  /// Opens, binds, joins and sends the first firewall opener.
  /// Throws UsageError for an address or interface that is none, InputError for what the system
  /// refuses, above all a port in use.
  explicit Receiver(const ReceiverOptions& options);
  Receiver(const Receiver&) = delete;
  Receiver(Receiver&&) = delete;
  Receiver& operator=(const Receiver&) = delete;
  Receiver& operator=(Receiver&&) = delete;
  ~Receiver();

  std::uint16_t port() const { return port_; }  ///< the actual one
  int file_descriptor() const;                  ///< readable when a datagram waits
  const ReceiverCounters& counters() const { return counters_; }

  /// Waits at most `timeout` for data, then calls handler(const Datagram&) for every datagram in
  /// the queue, oldest first, at most kMostPerCall of them; the bytes are valid during the call.
  /// Returns how many were handed out. Nothing is allocated.
  template <typename Handler>
  std::size_t receive(std::chrono::milliseconds timeout, Handler&& handler) {
    std::size_t handed_out = 0;
    if (!wait(timeout)) return handed_out;
    for (std::size_t batch = 0; batch < kMostPerCall / kBatch; ++batch) {
      const bool more = fetch();
      for (const Datagram& datagram : fetched()) handler(datagram);
      handed_out += fetched().size();
      if (!more) break;
    }
    return handed_out;
  }

  static constexpr std::size_t kBatch = 16;          ///< datagrams per system call
  static constexpr std::size_t kMostPerCall = 1024;  ///< so that a flood cannot hold the caller

 private:
  struct Link;

  bool wait(std::chrono::milliseconds timeout);  ///< true if there is something to fetch
  bool fetch();                                  ///< one batch; true if more may be waiting
  void accept(std::size_t slot_index);
  std::span<const Datagram> fetched() const;
  void send_opener(std::int64_t now_ns);

  ReceiverCounters counters_;
  std::uint16_t port_{0};
  std::unique_ptr<Link> link_;
};

}  // namespace handeye::dtrack
