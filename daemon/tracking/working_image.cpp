// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/tracking/working_image.hpp"

#include <algorithm>

#include <opencv2/imgproc.hpp>

namespace handeye {
namespace {

/// Against grain, of which the averaging leaves half.
constexpr double kBlurPx = 0.8;
/// Side of the mean's window: larger than a patch, smaller than the shading.
constexpr int kMeanPx = 31;
/// Grey levels added to both sides of the quotient: where it is dark, noise is not blown up.
constexpr float kDarkLevel = 16.0F;
/// Grey levels of a pixel twice as bright as the mean, above the mean's 128.
constexpr float kContrast = 160.0F;
constexpr float kMiddle = 128.0F;

}  // namespace

WorkingImage::WorkingImage(cv::Size given) : given_(given), size_(given) {
  while (size_.width > kMaxWidth) size_ = size_ / 2;
}

void WorkingImage::prepare(const cv::Mat& grey) {
  if (is_shrunk()) {
    cv::resize(grey, grey_, size_, 0, 0, cv::INTER_AREA);
    cv::GaussianBlur(grey_, grey_, {}, kBlurPx);
  } else {
    grey_ = grey;
  }
  normalise();
}

void WorkingImage::normalise() {
  cv::boxFilter(grey_, mean_, CV_32F, {kMeanPx, kMeanPx});
  normalised_.create(size_, CV_8UC1);
  for (int y = 0; y < size_.height; ++y) {
    const auto* grey = grey_.ptr<std::uint8_t>(y);
    const auto* mean = mean_.ptr<float>(y);
    auto* normalised = normalised_.ptr<std::uint8_t>(y);
    for (int x = 0; x < size_.width; ++x) {
      const float ratio = (static_cast<float>(grey[x]) + kDarkLevel) / (mean[x] + kDarkLevel);
      const float level = kMiddle + kContrast * (ratio - 1.0F) + 0.5F;
      normalised[x] = static_cast<std::uint8_t>(std::clamp(level, 0.0F, 255.0F));
    }
  }
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
