// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/v4l2/v4l2_camera.hpp"

#include <algorithm>
#include <cerrno>
#include <poll.h>
#include <thread>

#include <fmt/format.h>

#include "drivers/image/sequence_gap.hpp"
#include "drivers/v4l2/v4l2_timestamp.hpp"
#include "protocol/bus.hpp"

namespace handeye {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

namespace {

constexpr milliseconds kFalseAlarmPause(1);

}  // namespace

V4l2Camera::V4l2Camera(V4l2CameraOptions options) : options_(std::move(options)) {}

std::optional<std::string> V4l2Camera::open() {
  close();
  auto problem = start();
  if (problem) {
    close();
  } else {
    ++counters_.opened;
  }
  return problem;
}

std::optional<std::string> V4l2Camera::start() {
  if (auto problem = device_.open(options_.device)) return problem;
  auto agreed = negotiate(device_, options_.wish);
  if (auto* const problem = std::get_if<std::string>(&agreed)) return std::move(*problem);
  stream_ = std::get<V4l2Stream>(agreed);
  if (auto problem = buffers_.start(device_)) return problem;
  last_frame_ = steady_clock::now();
  return std::nullopt;
}

void V4l2Camera::close() {
  buffers_.release();
  device_.close();  // which also stops the stream
  stream_ = V4l2Stream();
  last_sequence_.reset();
  last_timestamp_ns_ = 0;
}

GrabStatus V4l2Camera::grab(Frame& frame, milliseconds timeout) {
  if (!device_.is_open()) return GrabStatus::kLost;
  const auto deadline = steady_clock::now() + timeout;
  for (;;) {
    V4l2Filled filled;
    const Ready ready = take_next(filled, deadline);
    if (ready == Ready::kFailed) return lost();
    if (ready == Ready::kNothing) {
      const bool silent = steady_clock::now() - last_frame_ > options_.silent_is_lost;
      return silent ? lost() : GrabStatus::kTimeout;
    }
    const bool good = convert(filled, frame);
    if (buffers_.give_back(device_, filled.index) != 0) return lost();
    last_frame_ = steady_clock::now();
    if (good) return GrabStatus::kFrame;
  }
}

V4l2Camera::Ready V4l2Camera::take_next(V4l2Filled& filled, steady_clock::time_point deadline) {
  for (;;) {
    const auto left = std::chrono::ceil<milliseconds>(deadline - steady_clock::now());
    pollfd waiting{device_.descriptor(), POLLIN | POLLPRI, 0};
    const int ready = poll(&waiting, 1, static_cast<int>(std::max(left, milliseconds(0)).count()));
    if (ready < 0 && errno == EINTR) continue;
    if (ready < 0) return Ready::kFailed;
    if (ready == 0) return Ready::kNothing;
    if ((waiting.revents & (POLLERR | POLLHUP | POLLNVAL)) != 0) return Ready::kFailed;
    if ((waiting.revents & POLLPRI) != 0 && signal_changed()) return Ready::kFailed;
    if ((waiting.revents & POLLIN) != 0) {
      const int error = buffers_.take(device_, filled);
      if (error == 0) return Ready::kFrame;
      if (error != EAGAIN) return Ready::kFailed;
    }
    // A false alarm. Some drivers repeat it for ever: neither at full speed, nor beyond the
    // deadline.
    if (steady_clock::now() >= deadline) return Ready::kNothing;
    std::this_thread::sleep_for(kFalseAlarmPause);
  }
}

bool V4l2Camera::signal_changed() const {
  v4l2_event event{};
  while (device_.request(VIDIOC_DQEVENT, &event) == 0) {
    if (event.type == V4L2_EVENT_SOURCE_CHANGE) return true;
  }
  return false;
}

bool V4l2Camera::convert(const V4l2Filled& filled, Frame& frame) {
  const std::int64_t arrival_ns = monotonic_ns();
  const std::int64_t timestamp_ns =
      mid_exposure_ns(filled.flags, filled.timestamp, arrival_ns, options_.half_exposure_ns);
  if (last_sequence_) counters_.dropped += sequence_gap(*last_sequence_, filled.sequence);
  last_sequence_ = filled.sequence;

  const bool damaged = (filled.flags & V4L2_BUF_FLAG_ERROR) != 0;
  const EncodedImage image{stream_.format, stream_.width, stream_.height, stream_.stride_bytes,
                           filled.bytes};
  if (damaged || timestamp_ns <= last_timestamp_ns_ || !decoder_.decode(image, frame.grey)) {
    ++counters_.malformed;
    return false;
  }
  last_timestamp_ns_ = timestamp_ns;
  frame.timestamp_ns = timestamp_ns;
  frame.arrival_ns = arrival_ns;
  frame.sequence = filled.sequence;
  ++counters_.received;
  return true;
}

GrabStatus V4l2Camera::lost() {
  close();
  return GrabStatus::kLost;
}

std::string V4l2Camera::description() const {
  if (!device_.is_open()) return options_.device;
  std::string text = fmt::format("{} {}x{} {}", options_.device, stream_.width, stream_.height,
                                 name_of(stream_.format));
  if (stream_.rate_hz > 0) text += fmt::format(" {:.1f} Hz", stream_.rate_hz);
  if (stream_.interlaced) text += " interlaced";
  return text;
}

}  // namespace handeye
