// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <opencv2/core.hpp>

namespace handeye {

/// An image with a frame of padding around it, so that a patch near the border can be read without
/// asking at every pixel. The memory is kept from image to image.
template <typename Pixel>
class PaddedPlane {
 public:
  static constexpr int kPaddingPx = 40;

  void resize(cv::Size size) {
    if (size == size_) return;
    size_ = size;
    stride_ = static_cast<std::ptrdiff_t>(size.width) + 2 * kPaddingPx;
    const auto rows = static_cast<std::ptrdiff_t>(size.height) + 2 * kPaddingPx;
    // Whole vectors are read beyond the last pixel that counts.
    pixels_.assign(static_cast<std::size_t>(rows * stride_) + 64, Pixel{0});
  }

  cv::Size size() const { return size_; }
  std::ptrdiff_t stride() const { return stride_; }

  /// The pixel at column x of row y, both from -kPaddingPx.
  Pixel* at(int x, int y) { return pixels_.data() + offset(x, y); }
  const Pixel* at(int x, int y) const { return pixels_.data() + offset(x, y); }

  /// Is the rectangle [left, right] x [top, bottom] within image and padding?
  bool holds(int left, int top, int right, int bottom) const {
    return left >= -kPaddingPx && top >= -kPaddingPx && right < size_.width + kPaddingPx &&
           bottom < size_.height + kPaddingPx;
  }

  /// Fills the padding with the nearest pixel of the image.
  void replicate_border() {
    for (int y = 0; y < size_.height; ++y) {
      std::fill_n(at(-kPaddingPx, y), kPaddingPx, *at(0, y));
      std::fill_n(at(size_.width, y), kPaddingPx, *at(size_.width - 1, y));
    }
    for (int y = 1; y <= kPaddingPx; ++y) {
      std::copy_n(at(-kPaddingPx, 0), stride_, at(-kPaddingPx, -y));
      std::copy_n(at(-kPaddingPx, size_.height - 1), stride_,
                  at(-kPaddingPx, size_.height - 1 + y));
    }
  }

 private:
  std::ptrdiff_t offset(int x, int y) const { return (y + kPaddingPx) * stride_ + x + kPaddingPx; }

  cv::Size size_;
  std::ptrdiff_t stride_{0};
  std::vector<Pixel> pixels_;
};

}  // namespace handeye
