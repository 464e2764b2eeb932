// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/image/grey_decoder.hpp"

#include <cstddef>

namespace handeye {
namespace {

int bytes_per_pixel(PixelFormat format) {
  return format == PixelFormat::kYuyv || format == PixelFormat::kUyvy ? 2 : 1;
}

/// The rows of the image (of its plane of luminance) as a matrix over the given bytes; empty when
/// the bytes do not hold them. The last row's padding may be missing.
cv::Mat rows_of(const EncodedImage& image) {
  const int row_bytes = image.width * bytes_per_pixel(image.format);
  const int stride = image.stride_bytes == 0 ? row_bytes : image.stride_bytes;
  if (stride < row_bytes) return {};
  const std::size_t needed =
      static_cast<std::size_t>(stride) * static_cast<std::size_t>(image.height - 1) +
      static_cast<std::size_t>(row_bytes);
  if (image.bytes.size() < needed) return {};
  // OpenCV has no matrix over constant memory; this one is only read.
  auto* const first = const_cast<std::uint8_t*>(image.bytes.data());
  return cv::Mat(image.height, image.width, CV_8UC(bytes_per_pixel(image.format)), first,
                 static_cast<std::size_t>(stride));
}

}  // namespace

bool GreyDecoder::decode(const EncodedImage& image, cv::Mat& grey) {
  if (image.width < 1 || image.height < 1 || image.width > kMaxImageSide ||
      image.height > kMaxImageSide) {
    return false;
  }
  if (image.format == PixelFormat::kJpeg) {
    return jpeg_.decode(image.bytes, cv::Size(image.width, image.height), grey);
  }
  const cv::Mat rows = rows_of(image);
  if (rows.empty()) return false;
  switch (image.format) {
    case PixelFormat::kYuyv:
      cv::extractChannel(rows, grey, 0);
      break;
    case PixelFormat::kUyvy:
      cv::extractChannel(rows, grey, 1);
      break;
    default:
      rows.copyTo(grey);
  }
  return true;
}

}  // namespace handeye
