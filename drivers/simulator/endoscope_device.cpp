// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/endoscope_device.hpp"

#include <algorithm>

#include <opencv2/imgcodecs.hpp>

namespace handeye::simulator {
namespace {

/// From the grabber's stamp to the program that wants the frame.
constexpr std::int64_t kDeliveryNs = 2'000'000;

}  // namespace

EndoscopeDevice::EndoscopeDevice(const World& world) : world_(&world), view_(world) {}

double EndoscopeDevice::exposure_s(std::uint32_t number) const {
  return view_.exposed_s(number);
}

std::int64_t EndoscopeDevice::timestamp_ns(std::uint32_t number) const {
  return world_->host_ns(exposure_s(number) + world_->camera_delay_s);
}

void EndoscopeDevice::make(std::uint32_t number, SimulatedFrame& frame) {
  frame.number = number;
  frame.exposed_s = exposure_s(number);
  frame.timestamp_ns = timestamp_ns(number);
  frame.arrival_ns = frame.timestamp_ns + kDeliveryNs;
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
