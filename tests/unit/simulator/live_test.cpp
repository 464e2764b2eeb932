// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/live.hpp"

#include <arpa/inet.h>
#include <atomic>
#include <chrono>
#include <netinet/in.h>
#include <string>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <handeye/image_t.hpp>

#include "drivers/dtrack/parser.hpp"
#include "protocol/bus.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye::simulator {
namespace {

/// A UDP socket on a free port of the loopback.
class Listener {
 public:
  Listener() : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(bind(socket_, reinterpret_cast<const sockaddr*>(&address), size), 0);
    EXPECT_EQ(getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size), 0);
    port_ = ntohs(address.sin_port);
  }
  ~Listener() { close(socket_); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  std::uint16_t port() const { return port_; }

  /// What has arrived and waits.
  std::vector<std::string> waiting() const {
    std::vector<std::string> datagrams;
    std::string buffer(65536, '\0');
    while (true) {
      const ssize_t size = recv(socket_, buffer.data(), buffer.size(), MSG_DONTWAIT);
      if (size < 0) return datagrams;
      datagrams.push_back(buffer.substr(0, static_cast<std::size_t>(size)));
    }
  }

 private:
  int socket_;
  std::uint16_t port_{0};
};

struct ReceivedFrame {
  std::int64_t early_ns;  ///< before its time stamp; negative: after
  image_t message;
};

class LiveTest : public testing::Test {
 protected:
  static SimulatorOptions simulator_options() {
    SimulatorOptions options;
    options.seed = 19;
    return options;
  }

  LiveOptions live_options() const {
    LiveOptions options;
    options.tracker_port = listener_.port();
    options.lcm_url = fmt::format("udpm://239.255.76.67:{}?ttl=0&recv_buf_size=4194304", lcm_port_);
    options.channel_prefix = "SIMTEST_";
    return options;
  }

  Listener listener_;
  std::uint16_t lcm_port_{Listener().port()};  ///< free again, and another than the tracker's
  World world_{simulator_options(), 0};
};

TEST_F(LiveTest, SendsBothDevicesInTime) {
  std::unique_ptr<Bus> bus;
  try {
    bus = std::make_unique<Bus>(live_options().lcm_url);
  } catch (const InputError& error) {
    GTEST_SKIP() << error.what();
  }
  std::vector<ReceivedFrame> frames;
  bus->subscribe<image_t>("SIMTEST_FRAME", [&](const image_t& message) {
    frames.push_back({message.timestamp_ns - monotonic_ns(), message});
  });
  std::jthread receiving([&bus](const std::stop_token& stop) {
    while (!stop.stop_requested()) bus->handle(std::chrono::milliseconds(10));
    while (bus->handle(std::chrono::milliseconds(100))) {
    }
  });

  world_.start_ns = monotonic_ns() + 200'000'000;
  const DeviceCounts counts = run_live(world_, 1.2, live_options(), [] { return false; });
  EXPECT_GE(monotonic_ns(), world_.host_ns(1.15));
  receiving.request_stop();
  receiving.join();

  EXPECT_EQ(counts.frames + counts.frames_skipped, 30U);
  EXPECT_GE(counts.frames, 1U);
  EXPECT_EQ(frames.size(), counts.frames);
  const std::int64_t delay_ns = world_.host_ns(world_.camera_delay_s) - world_.host_ns(0);
  for (const ReceivedFrame& frame : frames) {
    EXPECT_LE(frame.early_ns, 0);
    const auto number = static_cast<double>(frame.message.frame_number);
    EXPECT_NEAR(static_cast<double>(frame.message.timestamp_ns - world_.start_ns - delay_ns),
                number * 4e7, 2.0);
    EXPECT_EQ(frame.message.pixel_format, image_t::JPEG);
    EXPECT_EQ(frame.message.width, 640);
    EXPECT_EQ(frame.message.height, 480);
    EXPECT_LT(frame.message.size, 100'000);
  }

  const auto datagrams = listener_.waiting();
  EXPECT_EQ(counts.datagrams, 72U);
  ASSERT_EQ(datagrams.size(), counts.datagrams);
  dtrack::Parser parser;
  dtrack::Frame frame;
  for (const std::string& datagram : datagrams) {
    EXPECT_EQ(parser.parse(datagram, frame), dtrack::ParseStatus::kComplete);
  }
}

TEST_F(LiveTest, SkipsFramesRatherThanFallBehind) {
  SimulatorOptions options = simulator_options();
  options.camera_rate_hz = 240;
  options.width = 1280;
  options.height = 960;
  World world(options, monotonic_ns());
  DeviceCounts counts;
  try {
    counts = run_live(world, 0.5, live_options(), [] { return false; });
  } catch (const InputError& error) {
    GTEST_SKIP() << error.what();
  }
  // A megapixel cannot be rendered in 4 ms, so most of the 120 frames are left out.
  EXPECT_GT(counts.frames_skipped, 0U);
  EXPECT_LE(counts.frames + counts.frames_skipped, 120U);
}

TEST_F(LiveTest, StopsWhenTold) {
  world_.start_ns = monotonic_ns();
  int asked = 0;
  DeviceCounts counts;
  try {
    counts = run_live(world_, 0, live_options(), [&] { return ++asked > 10; });
  } catch (const InputError& error) {
    GTEST_SKIP() << error.what();
  }
  EXPECT_EQ(asked, 11);
  EXPECT_GT(counts.datagrams, 0U);
}

TEST_F(LiveTest, SendsDatagramsOnlyWhileTracking) {
  world_.start_ns = monotonic_ns();
  LiveOptions options = live_options();
  int asked = 0;
  // Off, on from the 11th datagram to the 20th, off again.
  options.tracking = [&asked] { return ++asked > 10 && asked <= 20; };
  DeviceCounts counts;
  try {
    counts = run_live(world_, 0.5, options, [] { return false; });
  } catch (const InputError& error) {
    GTEST_SKIP() << error.what();
  }
  EXPECT_EQ(asked, 30);
  EXPECT_EQ(counts.datagrams, 10U);
  const auto datagrams = listener_.waiting();
  ASSERT_EQ(datagrams.size(), 10U);
  dtrack::Parser parser;
  dtrack::Frame first;
  dtrack::Frame last;
  parser.parse(datagrams.front(), first);
  parser.parse(datagrams.back(), last);
  EXPECT_EQ(last.number, first.number + 9) << "the counter goes on";
}

TEST_F(LiveTest, SaysWhichVideoDeviceTakesNoPictures) {
  for (const std::string device : {"/dev/no-such-video", "/dev/null"}) {
    LiveOptions options = live_options();
    options.camera_device = device;
    try {
      run_live(world_, 0.1, options, [] { return true; });
      FAIL() << "no error";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(device), std::string::npos) << error.what();
    }
  }
}

TEST_F(LiveTest, SaysWhichHostIsUnknown) {
  LiveOptions options = live_options();
  options.tracker_host = "no-such-host.invalid";
  try {
    run_live(world_, 0.1, options, [] { return true; });
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("no-such-host.invalid"), std::string::npos);
  }
}

}  // namespace
}  // namespace handeye::simulator
