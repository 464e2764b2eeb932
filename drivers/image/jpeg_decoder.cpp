// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/image/jpeg_decoder.hpp"

#include <csetjmp>
#include <cstdio>  // jpeglib.h needs FILE
#include <jerror.h>
#include <jpeglib.h>

#include "drivers/image/encoded_image.hpp"

namespace handeye {

/// libjpeg's decompressor with error handlers that neither print nor exit.
struct JpegDecoder::Libjpeg {
  jpeg_decompress_struct decompressor{};
  jpeg_error_mgr errors{};
  std::jmp_buf on_error{};
  bool damaged{false};

  Libjpeg() {
    decompressor.err = jpeg_std_error(&errors);
    errors.error_exit = [](j_common_ptr common) { std::longjmp(of(common).on_error, 1); };
    errors.emit_message = [](j_common_ptr common, int level) {
      // Level -1 is a warning. Stray bytes between segments are a habit of many USB cameras and
      // harm nothing; every other warning means that image data are missing or wrong.
      if (level < 0 && common->err->msg_code != JWRN_EXTRANEOUS_DATA) of(common).damaged = true;
    };
    errors.output_message = [](j_common_ptr) {};
    decompressor.client_data = this;
    jpeg_create_decompress(&decompressor);
  }
  ~Libjpeg() { jpeg_destroy_decompress(&decompressor); }
  Libjpeg(const Libjpeg&) = delete;
  Libjpeg& operator=(const Libjpeg&) = delete;

  static Libjpeg& of(j_common_ptr common) { return *static_cast<Libjpeg*>(common->client_data); }

  /// Reads the header; the image's size, or nothing when it is no JPEG.
  std::optional<cv::Size> read_header(std::span<const std::uint8_t> bytes) {
    if (setjmp(on_error) != 0) return std::nullopt;
    damaged = false;
    jpeg_mem_src(&decompressor, bytes.data(), static_cast<unsigned long>(bytes.size()));
    jpeg_read_header(&decompressor, TRUE);
    return cv::Size(static_cast<int>(decompressor.image_width),
                    static_cast<int>(decompressor.image_height));
  }

  /// Decodes what read_header() announced into `grey`, which has that size.
  bool read_rows(cv::Mat& grey) {
    if (setjmp(on_error) != 0) return false;
    decompressor.out_color_space = JCS_GRAYSCALE;
    jpeg_start_decompress(&decompressor);
    while (decompressor.output_scanline < decompressor.output_height) {
      JSAMPROW row = grey.ptr(static_cast<int>(decompressor.output_scanline));
      jpeg_read_scanlines(&decompressor, &row, 1);
    }
    return !damaged;
  }
};

JpegDecoder::JpegDecoder() : libjpeg_(std::make_unique<Libjpeg>()) {}

JpegDecoder::~JpegDecoder() = default;

bool JpegDecoder::decode(std::span<const std::uint8_t> bytes, std::optional<cv::Size> expected,
                         cv::Mat& grey) {
  if (bytes.empty()) return false;
  bool whole = false;
  const std::optional<cv::Size> size = libjpeg_->read_header(bytes);
  if (size && size->width <= kMaxImageSide && size->height <= kMaxImageSide &&
      (!expected || *size == *expected)) {
    grey.create(*size, CV_8UC1);
    whole = libjpeg_->read_rows(grey);
  }
  // Abort, not finish: all rows are there, and what follows them is of no interest.
  jpeg_abort_decompress(&libjpeg_->decompressor);
  return whole;
}

bool looks_like_jpeg(std::span<const std::uint8_t> bytes) {
  return bytes.size() > 2 && bytes[0] == 0xFF && bytes[1] == 0xD8 && bytes[2] == 0xFF;
}

}  // namespace handeye
