// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/tracker_starter.hpp"

#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/simulator/controller.hpp"
#include "protocol/bus.hpp"

namespace handeye {
namespace {

using simulator::Controller;
using simulator::ControllerFault;
using testing::HasSubstr;
using testing::IsEmpty;

/// As usual, only sooner.
constexpr StartPolicyOptions kSoon{.settle_ns = 0,
                                   .silence_ns = 300'000'000,
                                   .first_retry_ns = 300'000'000,
                                   .last_retry_ns = 300'000'000};

bool eventually(const std::function<bool()>& condition) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

Config::Tracker config_for(std::uint16_t command_port) {
  Config::Tracker config;
  config.controller = "127.0.0.1";
  config.command_port = command_port;
  config.start_tracking = true;
  return config;
}

dtrack::CommandOptions options_for(const Controller& controller) {
  return {.controller = "127.0.0.1", .port = controller.port()};
}

TEST(TrackerStarter, StartsTheTrackingAndStopsItInTheEnd) {
  const Controller controller({.port = 0});
  {
    TrackerStarter starter(
        config_for(controller.port()), [] { return 0; }, kSoon);
    EXPECT_FALSE(controller.tracking());
    EXPECT_THAT(starter.text(), IsEmpty());
    starter.start();
    EXPECT_TRUE(eventually([&] { return controller.tracking() && !starter.text().empty(); }));
    EXPECT_THAT(starter.text(), HasSubstr("controller 127.0.0.1: tracking was "));
  }
  EXPECT_FALSE(controller.tracking());
}

TEST(TrackerStarter, LeavesRunningWhatItDidNotStart) {
  const Controller controller({.port = 0});
  dtrack::start_tracking(options_for(controller));
  {
    TrackerStarter starter(
        config_for(controller.port()), [] { return 0; }, kSoon);
    starter.start();
    EXPECT_TRUE(eventually([&] { return !starter.text().empty(); }));
    EXPECT_THAT(starter.text(), HasSubstr("tracking was on already, but no packets come"));
  }
  EXPECT_TRUE(controller.tracking());
}

TEST(TrackerStarter, DoesNotTouchATrackerThatSends) {
  const Controller controller({.port = 0});
  {
    TrackerStarter starter(
        config_for(controller.port()), [] { return monotonic_ns(); }, kSoon);
    starter.start();
    std::this_thread::sleep_for(std::chrono::milliseconds(600));
    EXPECT_THAT(starter.text(), IsEmpty());
  }
  EXPECT_FALSE(controller.tracking());
}

TEST(TrackerStarter, IsSilentOncePacketsCome) {
  const Controller controller({.port = 0});
  std::atomic<bool> sends{false};
  TrackerStarter starter(
      config_for(controller.port()), [&] { return sends ? monotonic_ns() : 0; }, kSoon);
  starter.start();
  EXPECT_TRUE(eventually([&] { return !starter.text().empty(); }));
  sends = true;
  EXPECT_TRUE(eventually([&] { return starter.text().empty(); }));
}

TEST(TrackerStarter, StartsAgainWhatWasStopped) {
  const Controller controller({.port = 0});
  // Packets come as long as the tracking runs.
  std::atomic<std::int64_t> last_ns{0};
  TrackerStarter starter(
      config_for(controller.port()),
      [&] {
        if (controller.tracking()) last_ns = monotonic_ns();
        return last_ns.load();
      },
      kSoon);
  starter.start();
  EXPECT_TRUE(eventually([&] { return last_ns > 0; }));
  EXPECT_EQ(dtrack::stop_tracking(options_for(controller)).outcome, dtrack::CommandOutcome::kDone);
  EXPECT_TRUE(eventually([&] { return controller.tracking(); }));
}

TEST(TrackerStarter, WaitsForAControllerThatComesLater) {
  std::uint16_t port = 0;
  {
    const Controller reserved({.port = 0});
    port = reserved.port();
  }
  TrackerStarter starter(
      config_for(port), [] { return 0; }, kSoon);
  starter.start();
  EXPECT_TRUE(eventually([&] { return !starter.text().empty(); }));
  EXPECT_THAT(starter.text(), HasSubstr("Connection refused; next attempt"));
  const Controller controller({.port = port});
  EXPECT_TRUE(eventually([&] { return controller.tracking(); }));
}

TEST(TrackerStarter, TellsWhatTheControllerSays) {
  const Controller controller({.port = 0, .fault = ControllerFault::kError});
  TrackerStarter starter(
      config_for(controller.port()), [] { return 0; }, kSoon);
  starter.start();
  EXPECT_TRUE(eventually([&] { return !starter.text().empty(); }));
  EXPECT_THAT(starter.text(), HasSubstr("the controller refuses: internal error (error 99)"));
}

TEST(TrackerStarter, EndsWhileTheControllerIsSilent) {
  const Controller controller({.port = 0, .fault = ControllerFault::kSilent});
  const auto begin = std::chrono::steady_clock::now();
  {
    TrackerStarter starter(
        config_for(controller.port()), [] { return 0; }, kSoon);
    starter.start();
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(8))
      << "the time-out of a command is 10 s";
}

}  // namespace
}  // namespace handeye
