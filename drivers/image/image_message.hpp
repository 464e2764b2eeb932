// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <handeye/image_t.hpp>

#include "drivers/image/encoded_image.hpp"

namespace handeye {

/// image_t for messages from outside. LCM's generated decode() resizes to whatever length the
/// message claims, before it looks whether that many bytes came: a negative or huge length would
/// throw or eat the memory. This one looks first.
struct CheckedImage : image_t {
  /// As image_t::decode: the number of bytes read, negative when this is no image_t.
  int decode(const void* message, int offset, int max_length);
};

/// Nothing when the image can be used as a FRAME, else what is wrong, in words ("height must be
/// 1..16384"). JPEG data are not decoded here.
std::optional<std::string> image_problem(const image_t& image);

/// The image in the message; valid as long as the message. Only when image_problem() said nothing.
EncodedImage encoded_image(const image_t& image);

}  // namespace handeye
