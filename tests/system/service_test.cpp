// SPDX-License-Identifier: BSD-3-Clause
// The daemon as a service: what systemd hears of it, and what it hears of systemd.
#include <csignal>
#include <netinet/in.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/system/notifications.hpp"
#include "tests/system/room.hpp"
#include "tests/system/stopped_thread.hpp"

namespace handeye::test {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Key;
using testing::StartsWith;

constexpr seconds kSoon{20};

class ServiceSystem : public RoomTest {
 protected:
  bool spin_until(const std::function<bool()>& condition, milliseconds timeout = kSoon) {
    return room_.listener().spin_until(condition, timeout);
  }

  Room room_;
};

TEST_F(ServiceSystem, TellsSystemdHowItIs) {
  Notifications systemd(room_.path("notify"), seconds(1));
  room_.write_camera_file(kSomeCamera);
  ASSERT_TRUE(room_.start_daemon());
  ASSERT_TRUE(spin_until([&] { return systemd.count("WATCHDOG=1") >= 3; }));
  EXPECT_EQ(systemd.count("READY=1"), 1);
  EXPECT_THAT(systemd.lines(),
              Contains(AllOf(StartsWith("STATUS="), HasSubstr("waiting for packets"),
                             HasSubstr("not calibrated"))));
  EXPECT_LE(systemd.count("STATUS="), 3) << "only what changed";
  EXPECT_EQ(systemd.count("STOPPING=1"), 0);
  ASSERT_TRUE(room_.stop_daemon(kSoon).has_value());
  EXPECT_EQ(systemd.count("STOPPING=1"), 1);
}

TEST_F(ServiceSystem, WithoutAWatchdogItFeedsNone) {
  Notifications systemd(room_.path("notify"));
  room_.write_camera_file(kSomeCamera);
  ASSERT_TRUE(room_.start_daemon());
  room_.listener().spin_for(seconds(1));
  EXPECT_EQ(systemd.count("READY=1"), 1);
  EXPECT_EQ(systemd.count("WATCHDOG"), 0);
}

TEST_F(ServiceSystem, AStuckThreadIsNamedAndTheWatchdogStarves) {
  Notifications systemd(room_.path("notify"), milliseconds(600));
  room_.write_camera_file(kSomeCamera);
  ASSERT_TRUE(room_.start_daemon({.extra_lines = "[service]\nstuck_after_s = 1.5\n"}));
  ASSERT_TRUE(spin_until([&] { return systemd.count("WATCHDOG=1") >= 1; }));
  for (const char* name : {"tracker", "camera", "vision", "watch"}) {
    const auto threads = threads_of(room_.daemon().id());
    ASSERT_THAT(threads, Contains(Key(name)));
    const auto said = [&](const std::string& what) {
      return room_.daemon().err().find(fmt::format("the {} thread {}", name, what)) !=
             std::string::npos;
    };
    {
      const StoppedThread stuck(threads.at(name));
      if (!stuck.is_stopped()) GTEST_SKIP() << "this system does not permit ptrace of a child";
      ASSERT_TRUE(spin_until([&] { return said("has made no progress"); })) << name;
      systemd.forget();
      room_.listener().spin_for(seconds(2));
      EXPECT_EQ(systemd.count("WATCHDOG=1"), 0) << name;
    }
    EXPECT_TRUE(spin_until([&] { return systemd.count("WATCHDOG=1") >= 2; })) << name;
    EXPECT_TRUE(said("goes on")) << room_.daemon().err();
  }
}

TEST_F(ServiceSystem, OnlyReceivingThreadsMayHaveARealTimePriority) {
  room_.write_camera_file(kSomeCamera);
  ASSERT_TRUE(room_.start_daemon());
  const pid_t daemon = room_.daemon().id();
  const auto policy_of = [&](const char* name) {
    return sched_getscheduler(threads_of(daemon).at(name));
  };
  // STATUS comes from the main thread: the others begin, and settle what they may, when they are
  // let.
  const auto waits_for_work = [&](const char* name) {
    const auto threads = threads_of(daemon);
    return threads.contains(name) && is_waiting(daemon, threads.at(name));
  };
  const auto is_refused = [&](const char* name) {
    return room_.daemon().err().find(fmt::format("{}: no real-time priority", name)) !=
           std::string::npos;
  };
  for (const char* name : {"vision", "solver", "attempts", "final answer", "watch"}) {
    ASSERT_TRUE(spin_until([&] { return waits_for_work(name); })) << name;
    EXPECT_EQ(policy_of(name), SCHED_OTHER) << name;
  }
  EXPECT_EQ(policy_of("handeyed"), SCHED_OTHER);
  for (const char* name : {"tracker", "camera"}) {
    ASSERT_TRUE(spin_until([&] { return waits_for_work(name); })) << name;
    EXPECT_TRUE(spin_until([&] { return policy_of(name) == SCHED_RR || is_refused(name); }))
        << name;
    if (is_refused(name)) {
      EXPECT_EQ(policy_of(name), SCHED_OTHER) << name;
    }
  }
}

/// A socket that a program inherits.
class PassedSocket {
 public:
  explicit PassedSocket(int type) : descriptor_(socket(AF_INET, type, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  }
  ~PassedSocket() { close(descriptor_); }
  PassedSocket(const PassedSocket&) = delete;
  PassedSocket& operator=(const PassedSocket&) = delete;

  std::uint16_t port() const {
    sockaddr_in address{};
    socklen_t size = sizeof address;
    getsockname(descriptor_, reinterpret_cast<sockaddr*>(&address), &size);
    return ntohs(address.sin_port);
  }
  void send_to_itself(const std::string& text) const {
    sockaddr_in address{};
    socklen_t size = sizeof address;
    getsockname(descriptor_, reinterpret_cast<sockaddr*>(&address), &size);
    sendto(descriptor_, text.data(), text.size(), 0, reinterpret_cast<const sockaddr*>(&address),
           size);
  }

  /// The daemon as systemd starts it: the socket is descriptor 3, and the variables say so.
  std::vector<std::string> words(const Room& room) const {
    return {"bash", "-c",
            fmt::format("exec 3<&{}; export LISTEN_FDS=1 LISTEN_FDNAMES=tracker LISTEN_PID=$$; "
                        "exec '{}' --config '{}'",
                        descriptor_, handeyed(), room.path("handeyed.toml").string())};
  }

 private:
  int descriptor_;
};

TEST_F(ServiceSystem, ListensOnTheSocketThatSystemdPasses) {
  const PassedSocket passed(SOCK_DGRAM);
  for (int i = 0; i < 7; ++i) passed.send_to_itself("fr 1\r\n");
  room_.write_camera_file(kSomeCamera);
  room_.write_config();
  Process daemon(passed.words(room_));
  const auto heard = [&](std::int64_t received) {
    return spin_until([&] {
      const auto& statuses = room_.listener().statuses();
      return !statuses.empty() && statuses.back().tracker.received == received;
    });
  };
  ASSERT_TRUE(heard(0)) << daemon.err();
  EXPECT_THAT(daemon.err(), HasSubstr("7 datagrams from before are dropped"));
  EXPECT_THAT(room_.listener().statuses().back().tracker.text,
              HasSubstr(fmt::format("port {}", passed.port())));
  passed.send_to_itself("fr 2\r\n");
  EXPECT_TRUE(heard(1)) << daemon.err();
}

TEST_F(ServiceSystem, AnyOtherSocketIsAMistakeInTheUnits) {
  const PassedSocket passed(SOCK_STREAM);
  room_.write_camera_file(kSomeCamera);
  room_.write_config();
  const Finished finished = run(passed.words(room_), kSoon);
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_THAT(finished.err, AllOf(HasSubstr("tracker"), HasSubstr("ListenDatagram")));
}

}  // namespace
}  // namespace handeye::test
