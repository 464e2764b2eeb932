// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/endoscope_device.hpp"

#include <algorithm>

#include <opencv2/imgcodecs.hpp>

namespace handeye::simulator {

EndoscopeDevice::EndoscopeDevice(const World& world)
    : world_(&world), view_(world), delivery_(world) {}

double EndoscopeDevice::exposure_s(std::uint32_t number) const {
  return view_.exposed_s(number);
}

std::int64_t EndoscopeDevice::timestamp_ns(std::uint32_t number) const {
  return delivery_.timestamp_ns(exposure_s(number));
}

std::optional<std::int64_t> EndoscopeDevice::arrival_ns(std::uint32_t number) const {
  if (view_.fate(number).missing) return std::nullopt;
  return delivery_.arrival_ns(exposure_s(number));
}

void EndoscopeDevice::make(std::uint32_t number, SimulatedFrame& frame) {
  frame.number = number;
  frame.exposed_s = exposure_s(number);
  frame.timestamp_ns = timestamp_ns(number);
  frame.arrival_ns = arrival_ns(number).value_or(frame.timestamp_ns);
  view_.draw(number, frame.grey);
  encode(frame);
}

void EndoscopeDevice::encode(SimulatedFrame& frame) const {
  constexpr int kQualityStep = 10;
  int quality = world_->options.jpeg_quality;
  cv::imencode(".jpg", frame.grey, frame.jpeg, {cv::IMWRITE_JPEG_QUALITY, quality});
  while (frame.jpeg.size() > kLargestJpegBytes && quality > 1) {
    quality = std::max(1, quality - kQualityStep);
    cv::imencode(".jpg", frame.grey, frame.jpeg, {cv::IMWRITE_JPEG_QUALITY, quality});
  }
}

}  // namespace handeye::simulator
