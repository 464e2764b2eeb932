// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/sensor.hpp"

#include <algorithm>

#include "drivers/simulator/mixed_bits.hpp"
#include "drivers/simulator/random_stream.hpp"

namespace handeye::simulator {
namespace {

constexpr std::size_t kNoiseTable = 1 << 16;

}  // namespace

Sensor::Sensor(int width, std::uint64_t seed, double noise_grey)
    : noise_(kNoiseTable + static_cast<std::size_t>(width)), seed_(seed) {
  RandomStream random(seed, Purpose::kImageNoise);
  for (float& value : noise_) value = static_cast<float>(random.normal(noise_grey));
}

void Sensor::expose(const cv::Mat1f& radiance, std::uint64_t frame_number, const Exposure& exposure,
                    cv::Mat& grey) const {
  grey.create(radiance.rows, radiance.cols, CV_8UC1);
  const std::uint64_t frame_bits = mixed_bits(seed_, frame_number);
  for (int row = 0; row < radiance.rows; ++row) {
    const std::uint64_t row_bits = mixed_bits(frame_bits, static_cast<std::uint64_t>(row));
    const float* noise = noise_.data() + row_bits % kNoiseTable;
    const float* in = radiance[row];
    auto* out = grey.ptr<std::uint8_t>(row);
    for (int column = 0; column < radiance.cols; ++column) {
      const float signal = tone(exposure.gain * in[column]) + exposure.offset_grey;
      const float value = signal + noise[column] + 0.5F;
      out[column] = static_cast<std::uint8_t>(std::clamp(value, 0.0F, 255.0F));
    }
  }
}

}  // namespace handeye::simulator
