// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace handeye {

/// A smooth random texture, different for every seed.
inline cv::Mat smooth_texture(int width, int height, std::uint64_t seed, int type = CV_8UC1) {
  cv::Mat texture(height, width, type);
  cv::RNG random(seed);
  random.fill(texture, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(texture, texture, {0, 0}, 4.0);
  cv::normalize(texture, texture, 10, 245, cv::NORM_MINMAX);
  return texture;
}

/// The image as JPEG; `parameters` as for cv::imencode.
inline std::vector<std::uint8_t> as_jpeg(const cv::Mat& image,
                                         const std::vector<int>& parameters = {}) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", image, bytes, parameters);
  return bytes;
}

}  // namespace handeye
