// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dtrack/receiver.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <poll.h>
#include <string_view>
#include <sys/socket.h>

#include "drivers/dtrack/arrival_clock.hpp"
#include "drivers/dtrack/ipv4.hpp"
#include "drivers/dtrack/udp_socket.hpp"

namespace handeye::dtrack {
namespace {

/// More than a datagram can have: 65507 bytes.
constexpr std::size_t kLargestDatagram = 65'536;

/// Any text will do; the controller wants it to end with NUL, so that is sent too.
constexpr std::string_view kOpener("fw4handeyed\0", 12);

/// What the kernel tells beside a datagram.
struct Ancillary {
  std::optional<std::int64_t> realtime_ns;
  std::optional<std::uint32_t> drops;  ///< since the socket was opened; wraps
};

Ancillary read_ancillary(msghdr& header) {
  Ancillary found;
  for (cmsghdr* message = CMSG_FIRSTHDR(&header); message != nullptr;
       message = CMSG_NXTHDR(&header, message)) {
    if (message->cmsg_level != SOL_SOCKET) continue;
    if (message->cmsg_type == SCM_TIMESTAMPNS) {
      timespec stamp{};
      std::memcpy(&stamp, CMSG_DATA(message), sizeof stamp);
      found.realtime_ns = std::int64_t{stamp.tv_sec} * 1'000'000'000 + stamp.tv_nsec;
    } else if (message->cmsg_type == SO_RXQ_OVFL) {
      found.drops.emplace();
      std::memcpy(&*found.drops, CMSG_DATA(message), sizeof *found.drops);
    }
  }
  return found;
}

}  // namespace

/// Room for one batch, laid out once, and the socket it is filled from.
struct Receiver::Link {
  explicit Link(const ReceiverOptions& options);

  UdpSocket socket;
  std::optional<in_addr> source;
  std::optional<sockaddr_in> controller;
  std::int64_t opener_silence_ns;
  std::int64_t last_sign_of_life_ns{0};       ///< datagram accepted or opener sent
  std::optional<std::uint32_t> kernel_drops;  ///< as last told; nothing: a passed socket's past
  ArrivalClock clock;

  struct Slot {
    std::array<char, kLargestDatagram> bytes;
    sockaddr_in sender;
    alignas(cmsghdr) std::array<char, 128> control;
    iovec part;
  };
  std::array<Slot, kBatch> slots;
  std::array<mmsghdr, kBatch> headers;
  std::array<Datagram, kBatch> accepted;
  std::size_t accepted_count{0};
};

Receiver::Link::Link(const ReceiverOptions& options)
    : socket(options), opener_silence_ns(std::chrono::nanoseconds(options.opener_silence).count()) {
  if (!options.source_address.empty()) {
    source = parse_ipv4(options.source_address, "source address");
  }
  if (!options.controller_address.empty()) {
    controller = socket_address(parse_ipv4(options.controller_address, "controller address"),
                                options.controller_port);
  }
  if (!options.passed_descriptor) kernel_drops = 0;
  for (std::size_t i = 0; i < kBatch; ++i) {
    slots[i].part = {slots[i].bytes.data(), slots[i].bytes.size()};
  }
}

Receiver::Receiver(const ReceiverOptions& options) : link_(std::make_unique<Link>(options)) {
  port_ = link_->socket.port();
  counters_.stale = link_->socket.stale();
  send_opener(clock_ns(CLOCK_MONOTONIC));
}

Receiver::~Receiver() = default;

int Receiver::file_descriptor() const {
  return link_->socket.descriptor();
}

std::span<const Datagram> Receiver::fetched() const {
  return {link_->accepted.data(), link_->accepted_count};
}

bool Receiver::wait(std::chrono::milliseconds timeout) {
  pollfd descriptor{.fd = file_descriptor(), .events = POLLIN, .revents = 0};
  const int ready = poll(&descriptor, 1, static_cast<int>(timeout.count()));
  const std::int64_t now_ns = clock_ns(CLOCK_MONOTONIC);
  if (ready <= 0 && now_ns - link_->last_sign_of_life_ns >= link_->opener_silence_ns) {
    send_opener(now_ns);
  }
  return ready > 0;
}

void Receiver::send_opener(std::int64_t now_ns) {
  link_->last_sign_of_life_ns = now_ns;
  if (!link_->controller) return;
  const ssize_t sent =
      sendto(file_descriptor(), kOpener.data(), kOpener.size(), 0,
             reinterpret_cast<const sockaddr*>(&*link_->controller), sizeof *link_->controller);
  if (sent == static_cast<ssize_t>(kOpener.size())) {
    ++counters_.openers_sent;
  } else {
    ++counters_.socket_errors;
  }
}

bool Receiver::fetch() {
  link_->accepted_count = 0;
  for (std::size_t i = 0; i < kBatch; ++i) {
    Link::Slot& slot = link_->slots[i];
    msghdr header{};
    header.msg_name = &slot.sender;
    header.msg_namelen = sizeof slot.sender;
    header.msg_iov = &slot.part;
    header.msg_iovlen = 1;
    header.msg_control = slot.control.data();
    header.msg_controllen = slot.control.size();
    link_->headers[i] = {.msg_hdr = header, .msg_len = 0};
  }
  const int count =
      recvmmsg(file_descriptor(), link_->headers.data(), kBatch, MSG_DONTWAIT, nullptr);
  if (count <= 0) {
    if (count < 0 && errno != EAGAIN && errno != EINTR) ++counters_.socket_errors;
    return false;
  }
  link_->clock.sample();
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) accept(i);
  return static_cast<std::size_t>(count) == kBatch;
}

void Receiver::accept(std::size_t slot_index) {
  const Link::Slot& slot = link_->slots[slot_index];
  mmsghdr& header = link_->headers[slot_index];
  const Ancillary ancillary = read_ancillary(header.msg_hdr);
  if (ancillary.drops) {
    counters_.kernel_drops += *ancillary.drops - link_->kernel_drops.value_or(*ancillary.drops);
    link_->kernel_drops = ancillary.drops;
  }
  if (link_->source && slot.sender.sin_addr.s_addr != link_->source->s_addr) {
    ++counters_.ignored_source;
    return;
  }
  if (header.msg_len == 0) {
    ++counters_.empty;
    return;
  }
  ++counters_.received;
  counters_.bytes += header.msg_len;
  link_->last_sign_of_life_ns = link_->clock.now_ns();
  link_->accepted[link_->accepted_count++] = {
      .arrival_ns = ancillary.realtime_ns ? link_->clock.to_monotonic(*ancillary.realtime_ns)
                                          : link_->clock.now_ns(),
      .bytes = {slot.bytes.data(), header.msg_len}};
}

}  // namespace handeye::dtrack
