// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/image/encoded_image.hpp"

namespace handeye {

/// What the camera is asked for.
struct V4l2Wish {
  int width{0};       ///< px; 0 (with height 0): the size the device is set to
  int height{0};      ///< px
  double rate_hz{0};  ///< 0: the device's own
  /// What we take, best first. The first that reaches the rate is used. The raw formats lead:
  /// they cost no decoding and have no artefacts; JPEG is what is left when the cable is too
  /// narrow.
  std::vector<PixelFormat> formats{PixelFormat::kGrey, PixelFormat::kYuyv, PixelFormat::kUyvy,
                                   PixelFormat::kNv12, PixelFormat::kJpeg};
};

/// One combination that a device says it can deliver.
struct V4l2Mode {
  std::uint32_t fourcc{0};
  int width{0};           ///< px; 0 (with height 0): the device does not tell its sizes
  int height{0};          ///< px
  double max_rate_hz{0};  ///< 0: the device does not tell its rates
};

/// What we know to decode of a V4L2 pixel format; nothing for the others.
std::optional<PixelFormat> pixel_format_of(std::uint32_t fourcc);

/// "YUYV", "MJPG", ...
std::string fourcc_text(std::uint32_t fourcc);

/// The mode to set: of the wished size, in one of the wished formats, the first of them that
/// reaches the wished rate; if none does, the fastest. Nothing when the device has no such mode.
std::optional<V4l2Mode> choose_mode(std::span<const V4l2Mode> modes, const V4l2Wish& wish);

}  // namespace handeye
