// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/service/heart_monitor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/service/background_thread.hpp"

namespace handeye {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::int64_t kStep_ns = 200'000'000;
constexpr double kStep_s = 0.2;

/// Checks five times a second by a clock of its own.
class HeartMonitorTest : public testing::Test {
 protected:
  /// The last answer after so long; `each`: what happens before every check.
  bool after_s(
      double duration_s, const std::function<void()>& each = [] {}) {
    bool well = true;
    for (double passed_s = 0; passed_s < duration_s; passed_s += kStep_s) {
      each();
      now_ns_ += kStep_ns;
      well = monitor_.check(now_ns_);
    }
    return well;
  }

  std::int64_t now_ns_{1'000'000'000};
  Heartbeat tracker_;
  Heartbeat solver_;
  HeartMonitor monitor_;
};

TEST_F(HeartMonitorTest, WhoBeatsIsWell) {
  monitor_.add("tracker", tracker_, 1);
  EXPECT_TRUE(after_s(60, [&] { tracker_.beat(); }));
}

TEST_F(HeartMonitorTest, WhoHasNotBegunRests) {
  monitor_.add("tracker", tracker_, 1);
  EXPECT_TRUE(after_s(60));
}

TEST_F(HeartMonitorTest, WhoFallsSilentIsStuckAfterItsOwnTime) {
  monitor_.add("tracker", tracker_, 2);
  monitor_.add("solver", solver_, 30);
  tracker_.beat();
  solver_.beat();
  EXPECT_TRUE(after_s(2));
  EXPECT_FALSE(after_s(1));
  EXPECT_THAT(monitor_.stuck(), ElementsAre("tracker"));
  EXPECT_FALSE(after_s(30));
  EXPECT_THAT(monitor_.stuck(), ElementsAre("tracker", "solver"));
}

TEST_F(HeartMonitorTest, WhoGoesOnIsWellAgain) {
  monitor_.add("tracker", tracker_, 2);
  tracker_.beat();
  EXPECT_FALSE(after_s(5));
  tracker_.beat();
  EXPECT_TRUE(after_s(0.2));
  EXPECT_THAT(monitor_.stuck(), IsEmpty());
  EXPECT_FALSE(after_s(5)) << "and may be stuck again";
}

TEST_F(HeartMonitorTest, WhoRestsMayBeSilentForEver) {
  monitor_.add("solver", solver_, 2);
  solver_.beat();
  solver_.rest();
  EXPECT_TRUE(after_s(60));
  solver_.beat();
  EXPECT_FALSE(after_s(5)) << "a job that does not end";
}

TEST_F(HeartMonitorTest, ASleepOfTheWholeMachineIsNobodysFault) {
  monitor_.add("tracker", tracker_, 2);
  EXPECT_TRUE(after_s(10, [&] { tracker_.beat(); }));
  now_ns_ += 3'600'000'000'000;
  EXPECT_TRUE(after_s(0.2));
  EXPECT_TRUE(after_s(10, [&] { tracker_.beat(); }));
}

TEST_F(HeartMonitorTest, SaysOnceWhoIsStuck) {
  monitor_.add("tracker", tracker_, 1);
  tracker_.beat();
  testing::internal::CaptureStdout();
  after_s(20);
  const std::string log = testing::internal::GetCapturedStdout();
  const auto first = log.find("the tracker thread has made no progress");
  ASSERT_NE(first, std::string::npos) << log;
  EXPECT_EQ(log.find("no progress", first + 40), std::string::npos) << log;
}

TEST(BackgroundThreadHeartbeat, BeatsForAJobAndRestsAfterIt) {
  BackgroundThread thread;
  EXPECT_TRUE(thread.heartbeat().resting());
  std::promise<void> may_end;
  std::promise<void> has_begun;
  auto done = thread.run([&] {
    has_begun.set_value();
    may_end.get_future().wait();
  });
  has_begun.get_future().wait();
  EXPECT_FALSE(thread.heartbeat().resting());
  EXPECT_EQ(thread.heartbeat().beats(), 1U);
  may_end.set_value();
  done.wait();
  while (thread.busy()) std::this_thread::yield();
  EXPECT_TRUE(thread.heartbeat().resting());
}

}  // namespace
}  // namespace handeye
