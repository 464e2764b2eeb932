// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/sync/clock_hindsight.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace handeye {
namespace {

constexpr std::int64_t kHindsight_ns = 10'000'000'000;
constexpr std::int64_t kRefinement_ns = 2'500'000;

/// Whether `later` is a mapping that `sample` could have been stamped by.
bool knows_of(const HandSample& later, const HandSample& sample) {
  return later.clock_mapping && later.clock_epoch == sample.clock_epoch &&
         later.clock_mapping->run == sample.clock_mapping->run &&
         later.timestamp_ns - sample.timestamp_ns <= kHindsight_ns;
}

std::int64_t stamp_by(const ClockMapping& later, const ClockMapping& own) {
  const auto apart_ns = static_cast<double>(own.device_ns - later.device_ns);
  return own.device_ns + later.lateness_ns + std::llround(later.slope * apart_ns);
}

}  // namespace

PoseBuffer with_hindsight(const PoseBuffer& samples) {
  PoseBuffer result({.capacity = std::max<std::size_t>(samples.size(), 1)});
  std::size_t later = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    HandSample sample = samples.at(i);
    later = std::max(later, i);
    if (sample.clock_mapping) {
      while (later + 1 < samples.size() && knows_of(samples.at(later + 1), sample)) ++later;
      const std::int64_t stamp_ns =
          stamp_by(*samples.at(later).clock_mapping, *sample.clock_mapping);
      if (std::abs(stamp_ns - sample.timestamp_ns) <= kRefinement_ns) {
        sample.timestamp_ns = stamp_ns;
      }
    }
    result.push(sample);
  }
  return result;
}

}  // namespace handeye
