// SPDX-License-Identifier: BSD-3-Clause
// A socket that systemd opened before the daemon was there.
#include <arpa/inet.h>
#include <array>
#include <fcntl.h>
#include <netinet/in.h>
#include <string>
#include <sys/socket.h>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/dtrack/receiver.hpp"

namespace handeye::dtrack {
namespace {

sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

/// As systemd makes it: bound, blocking, in nobody's hands yet.
int bound_socket() {
  const int descriptor = socket(AF_INET, SOCK_DGRAM, 0);
  const sockaddr_in address = loopback(0);
  EXPECT_EQ(bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  return descriptor;
}

std::uint16_t port_of(int descriptor) {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &size);
  return ntohs(address.sin_port);
}

void send_to(std::uint16_t port, const std::string& text) {
  const int sender = socket(AF_INET, SOCK_DGRAM, 0);
  const sockaddr_in address = loopback(port);
  EXPECT_EQ(sendto(sender, text.data(), text.size(), 0, reinterpret_cast<const sockaddr*>(&address),
                   sizeof address),
            static_cast<ssize_t>(text.size()));
  close(sender);
}

std::vector<std::string> heard(Receiver& receiver) {
  std::vector<std::string> texts;
  receiver.receive(std::chrono::milliseconds(1000), [&](const Datagram& datagram) {
    texts.emplace_back(datagram.bytes.begin(), datagram.bytes.end());
  });
  return texts;
}

TEST(PassedSocket, IsListenedToOnItsOwnPort) {
  const int descriptor = bound_socket();
  const std::uint16_t port = port_of(descriptor);
  Receiver receiver({.port = 1, .passed_descriptor = descriptor});
  EXPECT_EQ(receiver.port(), port);
  EXPECT_EQ(receiver.counters().stale, 0U);
  send_to(port, "fr 1");
  EXPECT_EQ(heard(receiver), std::vector<std::string>{"fr 1"});
}

TEST(PassedSocket, WhatWaitedInItIsDroppedAndCounted) {
  const int descriptor = bound_socket();
  const std::uint16_t port = port_of(descriptor);
  for (int i = 0; i < 40; ++i) send_to(port, "fr " + std::to_string(i));
  send_to(port, "");
  Receiver receiver({.passed_descriptor = descriptor});
  EXPECT_EQ(receiver.counters().stale, 41U);
  send_to(port, "fr 99");
  EXPECT_EQ(heard(receiver), std::vector<std::string>{"fr 99"});
  EXPECT_EQ(receiver.counters().received, 1U);
}

TEST(PassedSocket, WhatTheKernelDroppedBeforeIsNotCountedAsOurs) {
  const int descriptor = bound_socket();
  const std::uint16_t port = port_of(descriptor);
  const int smallest = 1;
  setsockopt(descriptor, SOL_SOCKET, SO_RCVBUF, &smallest, sizeof smallest);
  const int count = 1;
  setsockopt(descriptor, SOL_SOCKET, SO_RXQ_OVFL, &count, sizeof count);
  for (int i = 0; i < 200; ++i) send_to(port, std::string(1000, 'x'));
  Receiver receiver({.passed_descriptor = descriptor});
  EXPECT_LT(receiver.counters().stale, 200U) << "the kernel dropped some";
  send_to(port, "fr 1");
  EXPECT_EQ(heard(receiver).size(), 1U);
  EXPECT_EQ(receiver.counters().kernel_drops, 0U);
}

TEST(PassedSocket, IsClosedInTheEndAndNotInherited) {
  const int descriptor = bound_socket();
  {
    const Receiver receiver({.passed_descriptor = descriptor});
    EXPECT_NE(fcntl(descriptor, F_GETFD) & FD_CLOEXEC, 0);
  }
  EXPECT_EQ(fcntl(descriptor, F_GETFD), -1);
}

}  // namespace
}  // namespace handeye::dtrack
