// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <variant>

#include "drivers/v4l2/v4l2_device.hpp"
#include "drivers/v4l2/v4l2_modes.hpp"

namespace handeye {

/// What a device has agreed to deliver, read back from it.
struct V4l2Stream {
  PixelFormat format{PixelFormat::kGrey};
  std::uint32_t fourcc{0};
  int width{0};   ///< px
  int height{0};  ///< px
  int stride_bytes{0};
  double rate_hz{0};       ///< 0: the device does not tell
  bool interlaced{false};  ///< both fields in one image: moving edges are combed
};

/// Agrees with a device on signal timings, format, size and rate, and subscribes to changes of the
/// signal. The agreement, or in one line why there is none.
std::variant<V4l2Stream, std::string> negotiate(const V4l2Device& device, const V4l2Wish& wish);

}  // namespace handeye
