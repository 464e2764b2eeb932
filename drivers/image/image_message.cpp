// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/image/image_message.hpp"

#include <cstdint>

namespace handeye {
namespace {

/// LCM writes integers with the highest byte first.
std::int32_t read_int32(const std::uint8_t* bytes) {
  return static_cast<std::int32_t>(std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 |
                                   std::uint32_t{bytes[2]} << 8 | std::uint32_t{bytes[3]});
}

/// True when both arrays of an encoded image_t lie inside the message.
bool lengths_fit(const std::uint8_t* message, std::int64_t message_length) {
  // Before `size`: the type's fingerprint, five int64_t, four int32_t.
  constexpr std::int64_t kSizeAt = 8 + 5 * 8 + 4 * 4;
  constexpr std::int64_t kInt32 = 4;
  if (message_length < kSizeAt + kInt32) return false;
  const std::int64_t size = read_int32(message + kSizeAt);
  const std::int64_t features_at = kSizeAt + kInt32 + size;
  if (size < 0 || message_length < features_at + kInt32) return false;
  const std::int64_t features = read_int32(message + features_at);
  constexpr std::int64_t kFeatureBytes = 8;  // x and y
  return features >= 0 && message_length >= features_at + kInt32 + features * kFeatureBytes;
}

}  // namespace

int CheckedImage::decode(const void* message, int offset, int max_length) {
  if (!lengths_fit(static_cast<const std::uint8_t*>(message) + offset, max_length)) return -1;
  return image_t::decode(message, offset, max_length);
}

std::optional<std::string> image_problem(const image_t& image) {
  if (image.timestamp_ns < 0) return "timestamp_ns must not be negative";
  if (image.frame_number < 0) return "frame_number must not be negative";
  if (image.width < 1 || image.width > kMaxImageSide) return "width must be 1..16384";
  if (image.height < 1 || image.height > kMaxImageSide) return "height must be 1..16384";
  if (image.size < 1) return "there are no image data";
  if (image.pixel_format == image_t::JPEG) return std::nullopt;
  if (image.pixel_format != image_t::GREY8) return "pixel_format must be GREY8 or JPEG";
  if (image.stride < image.width) return "stride must be at least the width";
  const std::int64_t needed = std::int64_t{image.stride} * (image.height - 1) + image.width;
  if (image.size < needed) return "the image data are shorter than stride and height say";
  return std::nullopt;
}

EncodedImage encoded_image(const image_t& image) {
  EncodedImage encoded;
  encoded.format = image.pixel_format == image_t::JPEG ? PixelFormat::kJpeg : PixelFormat::kGrey;
  encoded.width = image.width;
  encoded.height = image.height;
  encoded.stride_bytes = image.stride;
  encoded.bytes = {image.data.data(), image.data.size()};
  return encoded;
}

}  // namespace handeye
