// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/lcm/lcm_camera.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "drivers/image/sequence_gap.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::steady_clock;

namespace {

// A century: differences of such times are whole nanoseconds yet.
constexpr std::int64_t kEndOfTime_ns = 3'155'760'000'000'000'000;

}  // namespace

LcmCamera::LcmCamera(LcmCameraOptions options) : options_(std::move(options)) {}

std::optional<std::string> LcmCamera::open() {
  close();
  try {
    bus_ = std::make_unique<Bus>(options_.provider_url);
    bus_->subscribe<CheckedImage>(options_.channel,
                                  [this](const CheckedImage& image) { receive(image); });
  } catch (const InputError& error) {
    bus_.reset();
    return error.what();
  }
  ++counters_.opened;
  return std::nullopt;
}

void LcmCamera::close() {
  if (bus_) counters_.malformed += bus_->undecodable();
  bus_.reset();
  waiting_.clear();
  stream_ = Stream();
}

GrabStatus LcmCamera::grab(Frame& frame, milliseconds timeout) {
  if (!bus_) return GrabStatus::kLost;
  const auto deadline = steady_clock::now() + timeout;
  for (;;) {
    // LCM's own queue gives up its newest message when it is full, so it is emptied into ours
    // first. The bound keeps a sender that is faster than us from holding us here.
    for (std::size_t i = 0; i < 2 * kQueueLength && bus_->handle(milliseconds(0)); ++i) {
    }
    while (waiting_.front() != nullptr) {
      const bool taken = take_oldest(frame);
      waiting_.pop();
      if (taken) return GrabStatus::kFrame;
    }
    const auto left = std::chrono::ceil<milliseconds>(deadline - steady_clock::now());
    if (left <= milliseconds(0)) return GrabStatus::kTimeout;
    bus_->handle(left);
  }
}

void LcmCamera::receive(const CheckedImage& image) {
  const std::int64_t arrival_ns = monotonic_ns();
  if (image_problem(image) || !is_plausible(image, arrival_ns)) {
    ++counters_.malformed;
    return;
  }
  follow(image);
  if (!waiting_.push(image, arrival_ns)) ++counters_.dropped_queue;
}

bool LcmCamera::is_plausible(const image_t& image, std::int64_t arrival_ns) const {
  if (options_.any_clock) return image.timestamp_ns >= 0 && image.timestamp_ns < kEndOfTime_ns;
  const nanoseconds age(arrival_ns - image.timestamp_ns);
  return age <= options_.oldest_timestamp && age >= -options_.latest_timestamp &&
         image.timestamp_ns > stream_.timestamp_ns;
}

void LcmCamera::follow(const image_t& image) {
  const bool continues = stream_.width != 0 && image.session_id == stream_.session_id;
  if (continues) {
    counters_.dropped += sequence_gap(static_cast<std::uint32_t>(stream_.frame_number),
                                      static_cast<std::uint32_t>(image.frame_number));
    constexpr double kWeight = 0.05;  // the rate of about the last 20 images
    const double period_s = static_cast<double>(image.timestamp_ns - stream_.timestamp_ns) * 1e-9;
    // Stamps go back where a log is played again.
    if (period_s > 0) {
      stream_.period_s += (stream_.period_s == 0 ? 1 : kWeight) * (period_s - stream_.period_s);
    }
  }
  stream_.session_id = image.session_id;
  stream_.frame_number = image.frame_number;
  stream_.timestamp_ns = image.timestamp_ns;
  stream_.width = image.width;
  stream_.height = image.height;
  stream_.format = encoded_image(image).format;
}

bool LcmCamera::take_oldest(Frame& frame) {
  const ReceivedImage& received = *waiting_.front();
  if (!decoder_.decode(encoded_image(received.message), frame.grey)) {
    ++counters_.malformed;
    return false;
  }
  frame.timestamp_ns = received.message.timestamp_ns;
  frame.arrival_ns = received.arrival_ns;
  frame.sequence = static_cast<std::uint32_t>(received.message.frame_number);
  ++counters_.received;
  return true;
}

std::string LcmCamera::description() const {
  std::string text = "LCM channel " + options_.channel;
  if (stream_.width == 0) return text + ", nothing heard yet";
  text += fmt::format(" {}x{} {}", stream_.width, stream_.height, name_of(stream_.format));
  if (stream_.period_s > 0) text += fmt::format(" {:.1f} Hz", 1 / stream_.period_s);
  return text;
}

CameraCounters LcmCamera::counters() const {
  CameraCounters counters = counters_;
  if (bus_) counters.malformed += bus_->undecodable();
  return counters;
}

}  // namespace handeye
