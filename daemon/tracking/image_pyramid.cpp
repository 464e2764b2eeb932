// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/image_pyramid.hpp"

#include <algorithm>

namespace handeye {
namespace {

using GreyPlane = PaddedPlane<std::int16_t>;
using UsablePlane = PaddedPlane<std::uint8_t>;

/// Means of 2x2 pixels.
void halve(const cv::Mat& image, cv::Mat& half) {
  half.create(image.rows / 2, image.cols / 2, CV_8UC1);
  for (int y = 0; y < half.rows; ++y) {
    const auto* above = image.ptr<std::uint8_t>(2 * y);
    const auto* below = image.ptr<std::uint8_t>(2 * y + 1);
    auto* out = half.ptr<std::uint8_t>(y);
    for (int x = 0; x < half.cols; ++x) {
      const int sum = above[2 * x] + above[2 * x + 1] + below[2 * x] + below[2 * x + 1];
      out[x] = static_cast<std::uint8_t>((sum + 2) / 4);
    }
  }
}

/// What may be looked at of a mask's blocks of `side` pixels: those of which all may.
void shrink_mask(const cv::Mat& mask, int side, cv::Size size, cv::Mat& shrunk) {
  shrunk.create(size, CV_8UC1);
  for (int y = 0; y < size.height; ++y) {
    auto* out = shrunk.ptr<std::uint8_t>(y);
    std::fill_n(out, size.width, std::uint8_t{255});
    for (int row = 0; row < side; ++row) {
      const auto* in = mask.ptr<std::uint8_t>(side * y + row);
      for (int x = 0; x < size.width; ++x) {
        for (int i = 0; i < side; ++i) out[x] &= in[side * x + i];
      }
    }
  }
}

/// (1 2 1) x (1 2 1) of bytes, unnormalised: sixteenths.
void smooth(const cv::Mat& image, std::vector<std::int16_t>& sums, GreyPlane& smoothed) {
  const int columns = image.cols;
  sums.resize(static_cast<std::size_t>(columns) + 2);
  for (int y = 0; y < image.rows; ++y) {
    const auto* above = image.ptr<std::uint8_t>(std::max(y - 1, 0));
    const auto* here = image.ptr<std::uint8_t>(y);
    const auto* below = image.ptr<std::uint8_t>(std::min(y + 1, image.rows - 1));
    std::int16_t* sum = sums.data() + 1;
    for (int x = 0; x < columns; ++x) {
      sum[x] = static_cast<std::int16_t>(above[x] + 2 * here[x] + below[x]);
    }
    sum[-1] = sum[0];
    sum[columns] = sum[columns - 1];
    std::int16_t* out = smoothed.at(0, y);
    for (int x = 0; x < columns; ++x) {
      out[x] = static_cast<std::int16_t>(sum[x - 1] + 2 * sum[x] + sum[x + 1]);
    }
  }
  smoothed.replicate_border();
}

/// Every second pixel of the plane filtered with (1 2 1) x (1 2 1) / 16.
void decimate(const GreyPlane& fine, std::vector<std::int16_t>& sums, GreyPlane& coarse) {
  coarse.resize(cv::Size((fine.size().width + 1) / 2, (fine.size().height + 1) / 2));
  const int columns = fine.size().width;
  sums.resize(static_cast<std::size_t>(columns) + 4);
  for (int y = 0; y < coarse.size().height; ++y) {
    const std::int16_t* above = fine.at(-1, 2 * y - 1);
    const std::int16_t* here = fine.at(-1, 2 * y);
    const std::int16_t* below = fine.at(-1, 2 * y + 1);
    for (int x = 0; x < columns + 2; ++x) {
      // At most 4 * 4080: fits.
      sums[static_cast<std::size_t>(x)] =
          static_cast<std::int16_t>(above[x] + 2 * here[x] + below[x]);
    }
    const std::int16_t* sum = sums.data() + 1;
    std::int16_t* out = coarse.at(0, y);
    for (int x = 0; x < coarse.size().width; ++x) {
      out[x] =
          static_cast<std::int16_t>((sum[2 * x - 1] + 2 * sum[2 * x] + sum[2 * x + 1] + 8) >> 4);
    }
  }
  coarse.replicate_border();
}

/// A pixel may be looked at when all that it was smoothed from may; one pixel in `step`.
template <typename Row>
void erode(const Row& mask_row, int columns, int step, UsablePlane& usable) {
  const cv::Size size = usable.size();
  for (int y = 0; y < size.height; ++y) {
    const std::uint8_t* above = mask_row(step * y - 1);
    const std::uint8_t* here = mask_row(step * y);
    const std::uint8_t* below = mask_row(step * y + 1);
    std::uint8_t* out = usable.at(0, y);
    const auto all_of = [&](int x) {
      return static_cast<std::uint8_t>(above[x] & here[x] & below[x]);
    };
    for (int x = 1; x < size.width - 1; ++x) {
      out[x] =
          static_cast<std::uint8_t>(all_of(step * x - 1) & all_of(step * x) & all_of(step * x + 1));
    }
    for (const int x : {0, size.width - 1}) {
      out[x] = static_cast<std::uint8_t>(all_of(std::max(step * x - 1, 0)) & all_of(step * x) &
                                         all_of(std::min(step * x + 1, columns - 1)));
    }
  }
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  if (a.size() != b.size()) return false;
  for (int y = 0; y < a.rows; ++y) {
    if (!std::equal(a.ptr(y), a.ptr(y) + a.cols, b.ptr(y))) return false;
  }
  return true;
}

}  // namespace

void ImagePyramid::build(const cv::Mat& grey, const cv::Mat& mask, int halvings, int levels) {
  levels_ = std::clamp(levels, 1, kMaxLevels);
  const cv::Mat* base = &grey;
  if (halvings > 0) {
    halve(grey, shrunk_);
    for (int i = 1; i < halvings; ++i) {
      halve(shrunk_, shrunk_twice_);
      cv::swap(shrunk_, shrunk_twice_);
    }
    base = &shrunk_;
  }
  const bool new_size = grey_[0].size() != base->size();
  grey_[0].resize(base->size());
  smooth(*base, column_sums_, grey_[0]);
  for (int k = 1; k < levels_; ++k) decimate(grey_[index(k - 1)], column_sums_, grey_[index(k)]);

  const bool same_mask =
      mask.empty() ? whole_image_usable_ : !whole_image_usable_ && same(mask, mask_);
  if (new_size || !same_mask) build_usable(mask, halvings);
}

void ImagePyramid::build_usable(const cv::Mat& mask, int halvings) {
  whole_image_usable_ = mask.empty();
  // Highlights come and go: the copy's memory stays while there is no mask.
  if (!mask.empty()) mask.copyTo(mask_);
  const cv::Size size = grey_[0].size();
  UsablePlane& base = usable_[0];
  base.resize(size);
  if (mask.empty()) {
    for (int y = 0; y < size.height; ++y) std::fill_n(base.at(0, y), size.width, 255);
  } else {
    if (halvings > 0) shrink_mask(mask, 1 << halvings, size, shrunk_mask_);
    const cv::Mat& own = halvings > 0 ? shrunk_mask_ : mask;
    erode([&](int y) { return own.ptr(std::clamp(y, 0, own.rows - 1)); }, own.cols, 1, base);
  }
  std::int64_t usable_pixels = 0;
  for (int y = 0; y < size.height; ++y) {
    std::uint8_t* row = base.at(0, y);
    for (int x = 0; x < size.width; ++x) {
      row[x] = row[x] != 0 ? 255 : 0;
      usable_pixels += row[x] & 1;
    }
  }
  usable_share_ = static_cast<double>(usable_pixels) / static_cast<double>(size.area());
  for (int k = 1; k < levels_; ++k) {
    usable_[index(k)].resize(grey_[index(k)].size());
    const UsablePlane& fine = usable_[index(k - 1)];
    erode([&](int y) { return fine.at(0, std::clamp(y, 0, fine.size().height - 1)); },
          fine.size().width, 2, usable_[index(k)]);
  }
}

bool ImagePyramid::all_usable(int level, int left, int top, int right, int bottom) const {
  const UsablePlane& plane = usable(level);
  if (left < 0 || top < 0 || right >= plane.size().width || bottom >= plane.size().height) {
    return false;
  }
  if (whole_image_usable_) return true;
  std::uint8_t all = 255;
  for (int y = top; y <= bottom; ++y) {
    const std::uint8_t* row = plane.at(0, y);
    for (int x = left; x <= right; ++x) all &= row[x];
  }
  return all != 0;
}

}  // namespace handeye
