// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>

namespace handeye {

/// How a camera lays out an image. Only the luminance is used, as the camera delivers it: video
/// range (16..235) is not stretched.
enum class PixelFormat {
  kGrey,  ///< one byte a pixel
  kYuyv,  ///< Y0 U Y1 V: two bytes a pixel, luminance first
  kUyvy,  ///< U Y0 V Y1: two bytes a pixel, luminance second
  kNv12,  ///< a plane of luminance, one byte a pixel, then a plane of colour that is not looked at
  kJpeg,  ///< one JPEG image (also what cameras call Motion-JPEG)
};

/// "GREY", "YUYV", "UYVY", "NV12", "JPEG": for people.
constexpr const char* name_of(PixelFormat format) {
  switch (format) {
    case PixelFormat::kGrey:
      return "GREY";
    case PixelFormat::kYuyv:
      return "YUYV";
    case PixelFormat::kUyvy:
      return "UYVY";
    case PixelFormat::kNv12:
      return "NV12";
    case PixelFormat::kJpeg:
      return "JPEG";
  }
  return "?";
}

/// Largest side of an image that is accepted anywhere [px].
inline constexpr int kMaxImageSide = 16384;

/// One image as delivered. The bytes belong to whoever hands it out.
struct EncodedImage {
  PixelFormat format{PixelFormat::kGrey};
  int width{0};         ///< px, 1..kMaxImageSide; kJpeg: what the JPEG must turn out to be
  int height{0};        ///< px, 1..kMaxImageSide
  int stride_bytes{0};  ///< from row to row, padding included; 0: no padding; kJpeg: not looked at
  std::span<const std::uint8_t> bytes;
};

}  // namespace handeye
