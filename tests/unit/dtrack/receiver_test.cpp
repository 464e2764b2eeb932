// SPDX-License-Identifier: BSD-3-Clause
// Over real sockets on the loopback interface.
#include "drivers/dtrack/receiver.hpp"

#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/dtrack/arrival_clock.hpp"
#include "protocol/exit_codes.hpp"
#include "tests/unit/dtrack/dtrack_text.hpp"
#include "tests/unit/dtrack/udp_sender.hpp"

namespace handeye::dtrack {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::ThrowsMessage;

ReceiverOptions loopback() {
  ReceiverOptions options;
  options.port = 0;
  options.bind_address = "127.0.0.1";
  return options;
}

struct Copy {
  std::int64_t arrival_ns;
  std::string text;
};

/// Everything until `count` datagrams have come, or five seconds without any.
std::vector<Copy> receive_all(Receiver& receiver, std::size_t count) {
  std::vector<Copy> copies;
  while (copies.size() < count) {
    const std::size_t handed_out = receiver.receive(5s, [&](const Datagram& datagram) {
      copies.push_back({datagram.arrival_ns, std::string(datagram.bytes)});
    });
    if (handed_out == 0) break;
  }
  return copies;
}

TEST(DTrackReceiver, HandsOutTheBytes) {
  Receiver receiver(loopback());
  UdpSender controller;
  ASSERT_TRUE(controller.send(sample("full_frame.txt"), receiver.port()));
  const auto datagrams = receive_all(receiver, 1);
  ASSERT_EQ(datagrams.size(), 1U);
  EXPECT_EQ(datagrams[0].text, sample("full_frame.txt"));
  EXPECT_EQ(receiver.counters().received, 1U);
  EXPECT_EQ(receiver.counters().bytes, sample("full_frame.txt").size());
}

// The datagram lies in the queue for a while: its time must be that of its arrival. The kernel
// begins to stamp some moments after it was asked to, hence the further tries.
TEST(DTrackReceiver, ArrivalIsTheKernelsNotOurs) {
  constexpr std::int64_t kQueued_ns = 10'000'000;
  constexpr std::int64_t kClockTolerance_ns = 1'000'000;
  Receiver receiver(loopback());
  UdpSender controller;
  bool seen = false;
  for (int attempt = 0; attempt < 100 && !seen; ++attempt) {
    const std::int64_t before_ns = clock_ns(CLOCK_MONOTONIC);
    ASSERT_TRUE(controller.send("fr 1\r\n", receiver.port()));
    const std::int64_t after_ns = clock_ns(CLOCK_MONOTONIC);
    std::this_thread::sleep_for(std::chrono::nanoseconds(kQueued_ns));
    const auto datagrams = receive_all(receiver, 1);
    ASSERT_EQ(datagrams.size(), 1U);
    ASSERT_GE(datagrams[0].arrival_ns, before_ns - kClockTolerance_ns);
    seen = datagrams[0].arrival_ns <= after_ns + kClockTolerance_ns;
  }
  EXPECT_TRUE(seen);
}

TEST(DTrackReceiver, ReturnsWithoutDataAfterTheTimeout) {
  Receiver receiver(loopback());
  EXPECT_EQ(receiver.receive(0ms, [](const Datagram&) { FAIL(); }), 0U);
  EXPECT_EQ(receiver.receive(5ms, [](const Datagram&) { FAIL(); }), 0U);
}

TEST(DTrackReceiver, Row29_ZeroLengthIsIgnoredAndCounted) {
  Receiver receiver(loopback());
  UdpSender controller;
  ASSERT_TRUE(controller.send("", receiver.port()));
  ASSERT_TRUE(controller.send("fr 1\r\n", receiver.port()));
  ASSERT_EQ(receive_all(receiver, 1).size(), 1U);
  EXPECT_EQ(receiver.counters().empty, 1U);
  EXPECT_EQ(receiver.counters().received, 1U);
  EXPECT_EQ(receiver.counters().socket_errors, 0U);
}

TEST(DTrackReceiver, Row30_LargestDatagramUdpCanCarry) {
  Receiver receiver(loopback());
  UdpSender controller;
  for (const std::size_t size : {32'767U, 65'507U}) {
    const std::string large = "fr 1\r\n" + std::string(size - 6, 'x');
    ASSERT_TRUE(controller.send(large, receiver.port()));
    const auto datagrams = receive_all(receiver, 1);
    ASSERT_EQ(datagrams.size(), 1U);
    EXPECT_EQ(datagrams[0].text, large);
  }
}

TEST(DTrackReceiver, Row33_ABurstIsProcessedCompletelyAndInOrder) {
  Receiver receiver(loopback());
  UdpSender controller;
  constexpr std::size_t kBurst = 200;
  for (std::size_t i = 0; i < kBurst; ++i) {
    ASSERT_TRUE(controller.send("fr " + std::to_string(i) + "\r\n", receiver.port()));
  }
  std::vector<Copy> datagrams;
  const std::size_t handed_out = receiver.receive(5s, [&](const Datagram& datagram) {
    datagrams.push_back({datagram.arrival_ns, std::string(datagram.bytes)});
  });
  EXPECT_EQ(handed_out, kBurst);
  ASSERT_EQ(datagrams.size(), kBurst);
  for (std::size_t i = 0; i < kBurst; ++i) {
    EXPECT_EQ(datagrams[i].text, "fr " + std::to_string(i) + "\r\n");
    EXPECT_GE(datagrams[i].arrival_ns, datagrams[i > 0 ? i - 1 : 0].arrival_ns);
  }
  EXPECT_EQ(receiver.counters().kernel_drops, 0U);
}

TEST(DTrackReceiver, CountsWhatTheKernelDropped) {
  ReceiverOptions options = loopback();
  options.receive_buffer_bytes = 1;  // the kernel takes its minimum
  Receiver receiver(options);
  UdpSender controller;
  constexpr std::size_t kSent = 300;
  const std::string text(1000, 'x');
  for (std::size_t i = 0; i < kSent; ++i) controller.send(text, receiver.port());
  const auto drain = [&] {
    while (receiver.receive(0ms, [](const Datagram&) {}) > 0) {
    }
  };
  drain();
  // The kernel tells the drops with the next datagram.
  ASSERT_TRUE(controller.send("fr 1\r\n", receiver.port()));
  receiver.receive(5s, [](const Datagram&) {});
  drain();
  EXPECT_GT(receiver.counters().kernel_drops, 0U);
  EXPECT_EQ(receiver.counters().received + receiver.counters().kernel_drops, kSent + 1);
}

TEST(DTrackReceiver, OnlyTheControllersAddressIsAccepted) {
  ReceiverOptions options = loopback();
  options.source_address = "127.0.0.2";
  Receiver receiver(options);
  UdpSender stranger;
  UdpSender controller("127.0.0.2");
  ASSERT_TRUE(stranger.send("fr 1\r\n", receiver.port()));
  ASSERT_TRUE(controller.send("fr 2\r\n", receiver.port()));
  ASSERT_TRUE(stranger.send("fr 3\r\n", receiver.port()));
  ASSERT_TRUE(controller.send("fr 4\r\n", receiver.port()));
  const auto datagrams = receive_all(receiver, 2);
  ASSERT_EQ(datagrams.size(), 2U);
  EXPECT_EQ(datagrams[0].text, "fr 2\r\n");
  EXPECT_EQ(datagrams[1].text, "fr 4\r\n");
  EXPECT_EQ(receiver.counters().ignored_source, 2U);
}

TEST(DTrackReceiver, OpensTheFirewallFromTheDataSocketAndAgainAfterSilence) {
  UdpSender controller;
  ReceiverOptions options = loopback();
  options.controller_address = "127.0.0.1";
  options.controller_port = controller.port();
  options.opener_silence = 50ms;
  Receiver receiver(options);
  const auto first = controller.receive();
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(first->text.back(), '\0');
  EXPECT_EQ(first->sender_port, receiver.port());
  EXPECT_EQ(receiver.counters().openers_sent, 1U);

  receiver.receive(60ms, [](const Datagram&) {});
  const auto second = controller.receive();
  ASSERT_TRUE(second.has_value());
  EXPECT_EQ(second->text, first->text);
  EXPECT_EQ(receiver.counters().openers_sent, 2U);
}

TEST(DTrackReceiver, NoOpenerWhileDataCome) {
  UdpSender controller;
  ReceiverOptions options = loopback();
  options.controller_address = "127.0.0.1";
  options.controller_port = controller.port();
  options.opener_silence = 1h;
  Receiver receiver(options);
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(controller.send("fr 1\r\n", receiver.port()));
    receiver.receive(5s, [](const Datagram&) {});
    receiver.receive(1ms, [](const Datagram&) {});
  }
  EXPECT_EQ(receiver.counters().openers_sent, 1U);
}

TEST(DTrackReceiver, AnOpenerThatCannotBeSentIsCountedOnly) {
  ReceiverOptions options = loopback();
  options.controller_address = "255.255.255.255";  // not allowed without SO_BROADCAST
  Receiver receiver(options);
  EXPECT_EQ(receiver.counters().openers_sent, 0U);
  EXPECT_EQ(receiver.counters().socket_errors, 1U);
}

std::string joining_failed(const ReceiverOptions& options, const InputError& error) {
  return "joining the multicast group " + options.multicast_group +
         " on the loopback interface failed; `ip link set lo multicast on`, or a network namespace "
         "that is allowed to, lets this test run: " +
         error.what();
}

TEST(DTrackReceiver, JoinsAMulticastGroupOnTheChosenInterface) {
  ReceiverOptions options;
  options.port = 0;
  options.interface = "lo";
  options.multicast_group = "239.255.76.5";
  std::optional<Receiver> receiver;
  try {
    receiver.emplace(options);
  } catch (const InputError& error) {
    GTEST_SKIP() << joining_failed(options, error);
  }
  UdpSender controller;
  if (!controller.send_to_loopback_multicast() ||
      !controller.send("fr 9\r\n", receiver->port(), options.multicast_group)) {
    GTEST_SKIP() << "sending to the multicast group " << options.multicast_group
                 << " over the loopback interface failed; `ip link set lo multicast on` lets this "
                    "test run";
  }
  const auto datagrams = receive_all(*receiver, 1);
  ASSERT_EQ(datagrams.size(), 1U);
  EXPECT_EQ(datagrams[0].text, "fr 9\r\n");
}

TEST(DTrackReceiver, JoinsAMulticastGroupOnTheInterfaceOfAnAddress) {
  ReceiverOptions options = loopback();
  options.multicast_group = "239.255.76.5";
  try {
    const Receiver receiver(options);
    EXPECT_GT(receiver.port(), 0);
  } catch (const InputError& error) {
    GTEST_SKIP() << joining_failed(options, error);
  }
}

TEST(DTrackReceiver, APortInUseIsOneClearLine) {
  const Receiver first(loopback());
  ReceiverOptions options = loopback();
  options.port = first.port();
  EXPECT_THAT([&] { Receiver second(options); },
              ThrowsMessage<InputError>(HasSubstr("port " + std::to_string(first.port()) +
                                                  " is in use by another program")));
}

TEST(DTrackReceiver, MistakesInTheOptionsAreNamed) {
  const auto with = [](auto member, const std::string& value) {
    return [member, value] {
      ReceiverOptions options = loopback();
      options.*member = value;
      Receiver receiver(options);
    };
  };
  EXPECT_THAT(with(&ReceiverOptions::bind_address, "localhost"),
              ThrowsMessage<UsageError>(HasSubstr("bind address 'localhost'")));
  EXPECT_THAT(with(&ReceiverOptions::source_address, "1.2.3"),
              ThrowsMessage<UsageError>(HasSubstr("source address '1.2.3'")));
  EXPECT_THAT(with(&ReceiverOptions::controller_address, "x"),
              ThrowsMessage<UsageError>(HasSubstr("controller address 'x'")));
  EXPECT_THAT(with(&ReceiverOptions::multicast_group, "10.0.0.1"),
              ThrowsMessage<UsageError>(HasSubstr("no multicast group")));
  EXPECT_THAT(with(&ReceiverOptions::interface, "nosuch0"),
              ThrowsMessage<UsageError>(HasSubstr("no network interface 'nosuch0'")));
  EXPECT_THAT(with(&ReceiverOptions::bind_address, "192.0.2.77"),
              ThrowsMessage<InputError>(HasSubstr("cannot be opened on 192.0.2.77")));
}

}  // namespace
}  // namespace handeye::dtrack
