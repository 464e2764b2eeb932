// SPDX-License-Identifier: BSD-3-Clause
#include "tests/unit/tracking/moving_texture.hpp"

#include <cmath>

#include <opencv2/imgproc.hpp>

namespace handeye::test {

MovingTexture::MovingTexture(cv::Size image_size, unsigned seed) : size_(image_size) {
  cv::RNG random(seed);
  texture_ = cv::Mat(2 * image_size.height, 2 * image_size.width, CV_8UC1);
  random.fill(texture_, cv::RNG::UNIFORM, 0, 256);
  // Blobs of a few pixels, with the full range of greys again.
  cv::GaussianBlur(texture_, texture_, {}, 2.5 * image_size.width / 640.0);
  cv::normalize(texture_, texture_, 20, 200, cv::NORM_MINMAX);
}

cv::Matx33d MovingTexture::image_from_texture(int frame) const {
  const double angle = 0.25 * std::sin(0.05 * frame);
  const double zoom = 1.0 + 0.12 * std::sin(0.04 * frame);
  const double c = zoom * std::cos(angle);
  const double s = zoom * std::sin(angle);
  const cv::Vec2d centre(0.5 * texture_.cols, 0.5 * texture_.rows);
  const cv::Vec2d target(0.5 * size_.width + 0.05 * size_.width * std::sin(0.07 * frame),
                         0.5 * size_.height + 0.05 * size_.width * std::sin(0.055 * frame));
  return {c, -s, target[0] - c * centre[0] + s * centre[1],  //
          s, c,  target[1] - s * centre[0] - c * centre[1],  //
          0, 0,  1};
}

cv::Mat MovingTexture::image(int frame, double light) const {
  cv::Mat image;
  cv::warpPerspective(texture_, image, image_from_texture(frame), size_, cv::INTER_CUBIC,
                      cv::BORDER_REFLECT_101);
  if (light <= 0) return image;
  for (int y = 0; y < image.rows; ++y) {
    auto* row = image.ptr<std::uint8_t>(y);
    for (int x = 0; x < image.cols; ++x) {
      const double r = std::hypot(x - 0.5 * image.cols, y - 0.5 * image.rows) / image.cols;
      row[x] = cv::saturate_cast<std::uint8_t>(row[x] * (1.1 - light * r * r * 4.0));
    }
  }
  return image;
}

Eigen::Vector2d MovingTexture::moved(const Eigen::Vector2d& pixel, int from, int to) const {
  const cv::Matx33d to_from = image_from_texture(to) * image_from_texture(from).inv();
  const cv::Vec3d moved = to_from * cv::Vec3d(pixel.x(), pixel.y(), 1.0);
  return {moved[0], moved[1]};
}

}  // namespace handeye::test
