// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dtrack/stream_monitor.hpp"

#include <gtest/gtest.h>

namespace handeye::dtrack {
namespace {

/// Feeds first, first + step, ... `count` numbers.
void feed(StreamMonitor& monitor, std::uint32_t first, std::uint32_t step, int count) {
  for (int i = 0; i < count; ++i, first += step) monitor.observe(first);
}

TEST(DTrackStreamMonitor, EveryFrame) {
  StreamMonitor monitor;
  EXPECT_EQ(monitor.observe(5), StreamEvent::kFirst);
  EXPECT_EQ(monitor.observe(6), StreamEvent::kNext);
  EXPECT_EQ(monitor.observe(9), StreamEvent::kGap);
  EXPECT_EQ(monitor.observe(9), StreamEvent::kRepeated);
  EXPECT_EQ(monitor.observe(10), StreamEvent::kNext);
  EXPECT_EQ(monitor.lost(), 2U);
  EXPECT_EQ(monitor.repeated(), 1U);
  EXPECT_EQ(monitor.divisor(), 1U);
}

TEST(DTrackStreamMonitor, EveryDivisorStepsWithoutLoss) {
  for (std::uint32_t divisor = 1; divisor <= StreamMonitor::kMaxDivisor; ++divisor) {
    StreamMonitor monitor;
    feed(monitor, 100, divisor, 50);
    EXPECT_EQ(monitor.divisor(), divisor);
    EXPECT_EQ(monitor.lost(), 0U);
    EXPECT_EQ(monitor.observe(100 + 50 * divisor + 2 * divisor), StreamEvent::kGap);
    EXPECT_EQ(monitor.lost(), 2U);
  }
}

TEST(DTrackStreamMonitor, ALateDatagramWasNotLost) {
  StreamMonitor monitor;
  feed(monitor, 100, 1, 10);
  EXPECT_EQ(monitor.observe(111), StreamEvent::kGap);
  EXPECT_EQ(monitor.lost(), 1U);
  EXPECT_EQ(monitor.observe(110), StreamEvent::kLate);
  EXPECT_EQ(monitor.lost(), 0U);
  EXPECT_EQ(monitor.observe(112), StreamEvent::kNext);
  EXPECT_EQ(monitor.late(), 1U);
  EXPECT_EQ(monitor.restarts(), 0U);
}

TEST(DTrackStreamMonitor, CountingAnewIsARestart) {
  StreamMonitor monitor;
  feed(monitor, 5000, 1, 10);
  EXPECT_EQ(monitor.observe(1), StreamEvent::kRestarted);
  EXPECT_EQ(monitor.observe(2), StreamEvent::kNext);
  EXPECT_EQ(monitor.restarts(), 1U);
  EXPECT_EQ(monitor.lost(), 0U);
}

TEST(DTrackStreamMonitor, ARestartSoonAfterAStartIsFoundAfterSomeFrames) {
  StreamMonitor monitor;
  feed(monitor, 1, 1, 8);
  monitor.observe(12);  // three lost
  feed(monitor, 1, 1, 20);
  EXPECT_EQ(monitor.restarts(), 1U);
  EXPECT_EQ(monitor.late(), 0U);
  EXPECT_EQ(monitor.lost(), 3U);
}

TEST(DTrackStreamMonitor, NumbersWrap) {
  StreamMonitor monitor;
  feed(monitor, 0xFFFFFFF0U, 2, 20);
  EXPECT_EQ(monitor.lost(), 0U);
  EXPECT_EQ(monitor.restarts(), 0U);
}

TEST(DTrackStreamMonitor, TheOperatorChangesTheDivisor) {
  StreamMonitor monitor;
  feed(monitor, 0, 1, 100);
  feed(monitor, 101, 2, 100);  // raised
  EXPECT_EQ(monitor.divisor(), 2U);
  EXPECT_EQ(monitor.lost(), 0U);
  feed(monitor, 300, 1, 100);  // and lowered
  EXPECT_EQ(monitor.divisor(), 1U);
  EXPECT_EQ(monitor.lost(), 0U);
}

}  // namespace
}  // namespace handeye::dtrack
