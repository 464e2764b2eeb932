// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

namespace handeye::simulator {

/// What the camera does to all of a picture at once.
struct Exposure {
  float gain{1.0F};         ///< of the light, before the tone curve
  float offset_grey{0.0F};  ///< grey levels, after it
};

/// Grey level of a radiance (1: a white surface, straight on, at the nominal distance): a camera
/// head's soft shoulder instead of clipping.
constexpr float tone(float radiance) {
  return 470.0F * radiance / (radiance + 1.3F);
}

/// The gain of the light that changes a grey level of about 120 by a factor (0..2).
constexpr double light_gain_of(double grey_gain) {
  constexpr double kMidGrey = 120.0;
  return grey_gain * (470.0 - kMidGrey) / (470.0 - grey_gain * kMidGrey);
}

/// Turns light into grey levels: exposure, tone curve, noise, rounding. One thread an object.
class Sensor {
 public:
  /// `noise_grey`: standard deviation of the image noise, grey levels.
  Sensor(int width, std::uint64_t seed, double noise_grey);

  /// `radiance` as wide as the sensor; `grey` becomes CV_8UC1 of the same size, its memory is kept
  /// when the size stays. `frame_number` picks the noise.
  void expose(const cv::Mat1f& radiance, std::uint64_t frame_number, const Exposure& exposure,
              cv::Mat& grey) const;

 private:
  std::vector<float> noise_;
  std::uint64_t seed_;
};

}  // namespace handeye::simulator
