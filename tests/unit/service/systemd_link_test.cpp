// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/systemd_link.hpp"

#include <array>
#include <cstdlib>
#include <pthread.h>
#include <sched.h>
#include <set>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/service/journal.hpp"
#include "daemon/service/news.hpp"
#include "daemon/service/thread_role.hpp"

namespace handeye {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

status_t quiet_status() {
  status_t status{};
  status.tracker.text = "port 5000";
  status.camera.text = "/dev/endoscope0 not there";
  return status;
}

TEST(SystemdStatus, TellsDevicesCalibrationAndSession) {
  status_t status = quiet_status();
  EXPECT_EQ(systemd_status(status),
            "tracker: port 5000; camera: /dev/endoscope0 not there; not calibrated");
  status.calibrated = 1;
  status.session_state = status_t::COLLECTING;
  EXPECT_THAT(systemd_status(status), HasSubstr("; calibrated; collecting"));
  status.calibration_restored = 1;
  EXPECT_THAT(systemd_status(status), HasSubstr("; calibrated before the restart; collecting"));
  status.watch_state = status_t::WATCH_BROKEN;
  EXPECT_THAT(systemd_status(status), HasSubstr("no longer holds"));
}

TEST(SystemdStatus, DoesNotChangeWithEveryFigure) {
  status_t status = quiet_status();
  const std::string before = systemd_status(status);
  status.uptime_s = 5;
  status.tracker.rate_hz = 60;
  status.tracker.age_s = 0.01;
  status.tracker.received = 1000;
  status.progress = 0.5;
  status.calibration_age_s = 100;
  EXPECT_EQ(systemd_status(status), before);
}

TEST(SystemdLink, FeedsAtAThirdOfTheLimit) {
  setenv("WATCHDOG_USEC", "6000000", 1);
  EXPECT_EQ(SystemdLink::feeding_period(), std::chrono::seconds(2));
  unsetenv("WATCHDOG_USEC");
  EXPECT_EQ(SystemdLink::feeding_period(), std::nullopt);
}

TEST(Journal, EveryKindOfEventHasAnIdOfItsOwn) {
  std::set<std::string> ids;
  constexpr int kKinds = static_cast<int>(Event::kThreadGoesOn) + 1;
  for (int kind = 0; kind < kKinds; ++kind) {
    const auto entry = journal_entry(static_cast<Event>(kind), "text", {});
    ASSERT_THAT(entry.at(1), StartsWith("MESSAGE_ID="));
    EXPECT_EQ(entry.at(1).size(), std::string("MESSAGE_ID=").size() + 32);
    ids.insert(entry.at(1));
  }
  EXPECT_EQ(ids.size(), static_cast<std::size_t>(kKinds));
}

TEST(Journal, CarriesTextPriorityAndFields) {
  const auto entry =
      journal_entry(Event::kDeviceLost, "the camera is gone", {{"DEVICE", "camera"}});
  EXPECT_THAT(entry, Contains("MESSAGE=the camera is gone"));
  EXPECT_THAT(entry, Contains("PRIORITY=4"));
  EXPECT_THAT(entry, Contains("DEVICE=camera"));
}

TEST(Journal, IsNotTakenForWhereStderrGoesWhenItIsAFile) {
  setenv("JOURNAL_STREAM", "1:2", 1);
  EXPECT_FALSE(stderr_is_the_journal());
  unsetenv("JOURNAL_STREAM");
  EXPECT_FALSE(stderr_is_the_journal());
}

TEST(DeviceNews, TellsComingAndGoingOnce) {
  DeviceNews news("camera");
  device_status_t status{};
  status.text = "/dev/video0";
  const auto said = [&](std::int32_t state) {
    status.state = state;
    testing::internal::CaptureStdout();
    news.hear(status);
    return testing::internal::GetCapturedStdout();
  };
  EXPECT_EQ(said(device_status_t::WAITING), "");
  EXPECT_THAT(said(device_status_t::STREAMING), HasSubstr("the camera streams: /dev/video0"));
  EXPECT_EQ(said(device_status_t::STREAMING), "");
  EXPECT_THAT(said(device_status_t::SILENT), HasSubstr("the camera is silent"));
  EXPECT_EQ(said(device_status_t::ABSENT), "") << "it was lost already";
}

struct Scheduling {
  int policy{-1};
  std::string name;
};

Scheduling in_a_thread_with(const ThreadRole& role) {
  Scheduling found;
  std::thread([&] {
    take_role(role);
    sched_param parameters{};
    pthread_getschedparam(pthread_self(), &found.policy, &parameters);
    std::array<char, 16> name{};
    pthread_getname_np(pthread_self(), name.data(), name.size());
    found.name = name.data();
  }).join();
  return found;
}

TEST(ThreadRole, NamesTheThread) {
  const Scheduling found = in_a_thread_with({.name = "vision"});
  EXPECT_EQ(found.name, "vision");
  EXPECT_EQ(found.policy, SCHED_OTHER);
}

/// Whether this test runs where it is permitted or not.
TEST(ThreadRole, GoesOnWithoutRealTimePriorityWhereItIsNotPermitted) {
  const Scheduling found = in_a_thread_with({"tracker", 20});
  EXPECT_EQ(found.name, "tracker");
  EXPECT_TRUE(found.policy == SCHED_RR || found.policy == SCHED_OTHER) << found.policy;
}

}  // namespace
}  // namespace handeye
