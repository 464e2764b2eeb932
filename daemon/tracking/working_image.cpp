// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/working_image.hpp"

#include <opencv2/imgproc.hpp>

namespace handeye {
namespace {

/// Against grain, which the averaging leaves half of.
constexpr double kBlurPx = 0.8;

}  // namespace

WorkingImage::WorkingImage(cv::Size given) : given_(given), size_(given) {
  while (size_.width > kMaxWidth) size_ = size_ / 2;
}

const cv::Mat& WorkingImage::shrink(const cv::Mat& grey) {
  if (!is_shrunk()) return grey;
  cv::resize(grey, shrunk_, size_, 0, 0, cv::INTER_AREA);
  cv::GaussianBlur(shrunk_, shrunk_, {}, kBlurPx);
  return shrunk_;
}

cv::Mat WorkingImage::shrink_mask(const cv::Mat& mask) const {
  cv::Mat shrunk;
  cv::resize(mask, shrunk, size_, 0, 0, cv::INTER_NEAREST);
  return shrunk;
}

Eigen::Vector2d WorkingImage::to_given(cv::Point2f pixel) const {
  const double x_scale = static_cast<double>(given_.width) / size_.width;
  const double y_scale = static_cast<double>(given_.height) / size_.height;
  return {(pixel.x + 0.5) * x_scale - 0.5, (pixel.y + 0.5) * y_scale - 0.5};
}

}  // namespace handeye
