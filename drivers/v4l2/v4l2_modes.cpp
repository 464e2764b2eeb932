// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/v4l2/v4l2_modes.hpp"

#include <algorithm>
#include <linux/videodev2.h>

namespace handeye {
namespace {

/// A device that says 29.97 does what was meant by 30.
constexpr double kRateTolerance = 0.99;

bool has_size(const V4l2Mode& mode, const V4l2Wish& wish) {
  const bool unknown = mode.width == 0;
  return unknown || (mode.width == wish.width && mode.height == wish.height);
}

bool reaches_rate(const V4l2Mode& mode, double rate_hz) {
  return mode.max_rate_hz == 0 || mode.max_rate_hz >= kRateTolerance * rate_hz;
}

}  // namespace

std::optional<PixelFormat> pixel_format_of(std::uint32_t fourcc) {
  switch (fourcc) {
    case V4L2_PIX_FMT_GREY:
      return PixelFormat::kGrey;
    case V4L2_PIX_FMT_YUYV:
      return PixelFormat::kYuyv;
    case V4L2_PIX_FMT_UYVY:
      return PixelFormat::kUyvy;
    case V4L2_PIX_FMT_NV12:
      return PixelFormat::kNv12;
    case V4L2_PIX_FMT_NV12M:
      return PixelFormat::kNv12;  // its first plane is the luminance
    case V4L2_PIX_FMT_MJPEG:
      return PixelFormat::kJpeg;
    case V4L2_PIX_FMT_JPEG:
      return PixelFormat::kJpeg;
    default:
      return std::nullopt;
  }
}

std::string fourcc_text(std::uint32_t fourcc) {
  std::string text;
  for (int shift = 0; shift < 32; shift += 8) {
    const auto letter = static_cast<char>(fourcc >> shift & 0x7F);
    text += letter >= ' ' && letter <= '~' ? letter : '?';
  }
  return text;
}

std::optional<V4l2Mode> choose_mode(std::span<const V4l2Mode> modes, const V4l2Wish& wish) {
  std::optional<V4l2Mode> fastest;
  for (const PixelFormat format : wish.formats) {
    for (const V4l2Mode& mode : modes) {
      if (pixel_format_of(mode.fourcc) != format || !has_size(mode, wish)) continue;
      if (reaches_rate(mode, wish.rate_hz)) return mode;
      if (!fastest || mode.max_rate_hz > fastest->max_rate_hz) fastest = mode;
    }
  }
  return fastest;
}

}  // namespace handeye
