// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/v4l2/v4l2_timestamp.hpp"

#include <linux/videodev2.h>

namespace handeye {
namespace {

// A frame waits at most a few periods for us; drivers that predict the end of a frame stamp it up
// to a period ahead. What lies beyond has another epoch or has wrapped.
constexpr std::int64_t kOldest_ns = 2'000'000'000;
constexpr std::int64_t kLatest_ns = 100'000'000;

bool is_plausible(const timeval& stamp, std::int64_t arrival_ns) {
  // In seconds first: a wrapped stamp overflows as nanoseconds.
  const std::int64_t arrival_s = arrival_ns / 1'000'000'000;
  if (stamp.tv_sec < arrival_s - 10 || stamp.tv_sec > arrival_s + 10) return false;
  const std::int64_t stamp_ns = stamp.tv_sec * 1'000'000'000LL + stamp.tv_usec * 1'000LL;
  return stamp_ns >= arrival_ns - kOldest_ns && stamp_ns <= arrival_ns + kLatest_ns;
}

}  // namespace

std::int64_t mid_exposure_ns(std::uint32_t flags, const timeval& stamp, std::int64_t arrival_ns,
                             std::int64_t half_exposure_ns) {
  const std::uint32_t clock = flags & V4L2_BUF_FLAG_TIMESTAMP_MASK;
  const bool is_capture_time =
      clock == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC || clock == V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN;
  if (!is_capture_time || !is_plausible(stamp, arrival_ns)) return arrival_ns - half_exposure_ns;
  const std::int64_t stamp_ns = stamp.tv_sec * 1'000'000'000LL + stamp.tv_usec * 1'000LL;
  const bool at_start = (flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  return at_start ? stamp_ns + half_exposure_ns : stamp_ns - half_exposure_ns;
}

}  // namespace handeye
