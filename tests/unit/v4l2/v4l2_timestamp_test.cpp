// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/v4l2/v4l2_timestamp.hpp"

#include <limits>
#include <linux/videodev2.h>

#include <gtest/gtest.h>

namespace handeye {
namespace {

constexpr std::int64_t kArrival_ns = 5'000'300'000'000;
constexpr std::int64_t kStamp_ns = 5'000'290'000'000;
constexpr std::int64_t kHalfExposure_ns = 4'000'000;
constexpr std::uint32_t kMonotonic = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
constexpr std::uint32_t kStart = V4L2_BUF_FLAG_TSTAMP_SRC_SOE;

timeval as_timeval(std::int64_t time_ns) {
  return {time_ns / 1'000'000'000, time_ns % 1'000'000'000 / 1000};
}

std::int64_t choose(std::uint32_t flags, std::int64_t stamp_ns) {
  return mid_exposure_ns(flags, as_timeval(stamp_ns), kArrival_ns, kHalfExposure_ns);
}

TEST(MidExposure, LiesBeforeAStampOfTheEnd) {
  EXPECT_EQ(choose(kMonotonic, kStamp_ns), kStamp_ns - kHalfExposure_ns);
}

TEST(MidExposure, LiesAfterAStampOfTheStart) {
  EXPECT_EQ(choose(kMonotonic | kStart, kStamp_ns), kStamp_ns + kHalfExposure_ns);
}

TEST(MidExposure, UsesStampsOfAnUnknownClockWhenTheyFit) {
  constexpr std::uint32_t kUnknown = V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN;
  EXPECT_EQ(choose(kUnknown, kStamp_ns), kStamp_ns - kHalfExposure_ns);
  constexpr std::int64_t kRealtime_ns = 1'700'000'000'000'000'000;
  EXPECT_EQ(choose(kUnknown, kRealtime_ns), kArrival_ns - kHalfExposure_ns);
}

TEST(MidExposure, NeverUsesCopiedStamps) {
  EXPECT_EQ(choose(V4L2_BUF_FLAG_TIMESTAMP_COPY, kStamp_ns), kArrival_ns - kHalfExposure_ns);
  EXPECT_EQ(choose(V4L2_BUF_FLAG_TIMESTAMP_COPY | kStart, kStamp_ns),
            kArrival_ns - kHalfExposure_ns);
}

TEST(MidExposure, FallsBackToTheArrivalWhenTheStampIsAbsurd) {
  for (const std::int64_t absurd :
       {std::int64_t{0}, kArrival_ns - 3'000'000'000, kArrival_ns + 200'000'000,
        std::numeric_limits<std::int64_t>::max()}) {
    EXPECT_EQ(choose(kMonotonic | kStart, absurd), kArrival_ns - kHalfExposure_ns) << absurd;
  }
  const timeval wrapped{std::numeric_limits<time_t>::max(), 999'999};
  EXPECT_EQ(mid_exposure_ns(kMonotonic, wrapped, kArrival_ns, 0), kArrival_ns);
}

TEST(MidExposure, AcceptsStampsALittleAhead) {
  const std::int64_t ahead_ns = kArrival_ns + 29'000'000;
  EXPECT_EQ(choose(kMonotonic, ahead_ns), ahead_ns - kHalfExposure_ns);
}

}  // namespace
}  // namespace handeye
