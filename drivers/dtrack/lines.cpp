// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/dtrack/lines.hpp"

#include <cstddef>
#include <cstdint>

namespace handeye::dtrack {
namespace {

constexpr std::size_t kLongestIdentifier = 8;

/// An identifier of up to 8 characters as one number, so that a switch can tell them apart.
constexpr std::uint64_t key(std::string_view identifier) {
  std::uint64_t key = 0;
  for (const char character : identifier) key = key << 8 | static_cast<unsigned char>(character);
  return key;
}

enum Part : int {
  kSecondsOfDay,
  kUnixTime,
  kCalibratedBodies,
  kCalibratedHands,
  kBodies,
  kHybridBodies,
  kCovariances,
  kFlysticks,
  kTools,
  kToolReferences,
  kMarkers,
  kHands,
  kHumans,
  kSystemStatus,
};

}  // namespace

LineType find_line_type(std::string_view identifier) {
  if (identifier.size() > kLongestIdentifier) return {};
  switch (key(identifier)) {
    case key("6d"):
      return {read_6d, kBodies};
    case key("ts"):
      return {read_ts, kSecondsOfDay};
    case key("ts2"):
      return {read_ts2, kUnixTime};
    case key("6dcal"):
      return {read_6dcal, kCalibratedBodies};
    case key("glcal"):
      return {read_glcal, kCalibratedHands};
    case key("6di"):
      return {read_6di, kHybridBodies};
    case key("6dcov"):
      return {read_6dcov, kCovariances};
    case key("6df"):
      return {read_6df, kFlysticks};
    case key("6df2"):
      return {read_6df2, kFlysticks};
    case key("6dmt"):
      return {read_6dmt, kTools};
    case key("6dmt2"):
      return {read_6dmt2, kTools};
    case key("6dmtr"):
      return {read_6dmtr, kToolReferences};
    case key("3d"):
      return {read_3d, kMarkers};
    case key("gl"):
      return {read_gl, kHands};
    case key("6dj"):
      return {read_6dj, kHumans};
    case key("st"):
      return {read_st, kSystemStatus};
    default:
      return {};
  }
}

}  // namespace handeye::dtrack
