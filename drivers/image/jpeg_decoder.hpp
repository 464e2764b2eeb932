// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include <opencv2/core.hpp>

namespace handeye {

/// Decodes the luminance of JPEG images, and tells a damaged one from a whole one. Reuses its
/// memory: no allocation of ours once the first image of a size has been decoded. Prints nothing.
class JpegDecoder {
 public:
  JpegDecoder();
  ~JpegDecoder();
  JpegDecoder(const JpegDecoder&) = delete;
  JpegDecoder& operator=(const JpegDecoder&) = delete;

  /// Writes the image into `grey` (CV_8UC1). False: not a JPEG, cut short, damaged, larger than
  /// kMaxImageSide, or not of the expected size; `grey` then holds nothing of use. An embedded
  /// orientation is ignored: pixels stay where the sensor had them.
  bool decode(std::span<const std::uint8_t> bytes, std::optional<cv::Size> expected, cv::Mat& grey);

 private:
  struct Libjpeg;
  std::unique_ptr<Libjpeg> libjpeg_;
};

/// True when the bytes begin as every JPEG does.
bool looks_like_jpeg(std::span<const std::uint8_t> bytes);

}  // namespace handeye
