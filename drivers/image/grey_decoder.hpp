// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include "drivers/image/encoded_image.hpp"
#include "drivers/image/jpeg_decoder.hpp"

namespace handeye {

/// Turns what a camera delivers into a grey image. Keeps its decoder from image to image.
class GreyDecoder {
 public:
  /// Writes the luminance into `grey` (CV_8UC1, width x height), which keeps its memory while the
  /// size stays. False: the bytes are too few for the format and size, or the JPEG is damaged or of
  /// another size; `grey` then holds nothing of use.
  bool decode(const EncodedImage& image, cv::Mat& grey);

 private:
  JpegDecoder jpeg_;
};

}  // namespace handeye
