// SPDX-License-Identifier: BSD-3-Clause
#include <limits>

#include "drivers/dtrack/lines.hpp"

namespace handeye::dtrack {
namespace {

constexpr double kSecondsPerDay = 86'400.0;
constexpr std::uint32_t kAnyUint32 = std::numeric_limits<std::uint32_t>::max();

bool read_single_count(Scanner& line, std::optional<std::int32_t>& published) {
  std::int32_t count = 0;
  if (!line.read_count(count) || !line.finish()) return false;
  published = count;
  return true;
}

}  // namespace

bool read_ts(Scanner& line, LineContext& context) {
  double seconds = 0;
  if (!line.read(seconds) || !line.finish()) return false;
  if (seconds < 0 || seconds >= kSecondsPerDay) return line.fail(ErrorKind::kNumberOutOfRange);
  context.frame.seconds_of_day = seconds;
  return true;
}

bool read_ts2(Scanner& line, LineContext& context) {
  UnixTime time;
  if (!line.read(time.seconds, 0, kAnyUint32) || !line.read(time.microseconds, 0, 999'999) ||
      !line.read(time.latency_us, 0, kAnyUint32) || !line.finish()) {
    return false;
  }
  context.frame.unix_time = time;
  return true;
}

bool read_6dcal(Scanner& line, LineContext& context) {
  return read_single_count(line, context.frame.calibrated_bodies);
}

bool read_glcal(Scanner& line, LineContext& context) {
  return read_single_count(line, context.frame.calibrated_hands);
}

}  // namespace handeye::dtrack
