// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/live.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <stop_token>
#include <thread>

#include <handeye/image_t.hpp>

#include "drivers/simulator/endoscope_device.hpp"
#include "drivers/simulator/pacing.hpp"
#include "drivers/simulator/tracker_link.hpp"
#include "drivers/simulator/udp_sender.hpp"
#include "drivers/simulator/v4l2_output.hpp"
#include "protocol/bus.hpp"

namespace handeye::simulator {
namespace {

/// Frames that exist at a time: rendering runs ahead by so many less the one being published.
constexpr int kFramesInFlight = 4;

/// Five years of frames at 25 Hz.
constexpr auto kEndlessFrames = std::numeric_limits<std::uint32_t>::max();

using FramePointer = std::unique_ptr<SimulatedFrame>;

/// The two devices, a thread for each task, and what they have sent.
class LiveDevices {
 public:
  LiveDevices(const World& world, double duration_s, const LiveOptions& options)
      : world_(&world),
        duration_s_(duration_s > 0 ? duration_s : std::numeric_limits<double>::infinity()),
        endoscope_(world),
        tracker_(world),
        sender_(options.tracker_host, options.tracker_port),
        tracking_(options.tracking),
        bus_(options.lcm_url),
        frames_out_(bus_, Channels(options.channel_prefix).frame) {
    if (!options.camera_device.empty()) {
      video_out_.emplace(options.camera_device, world.camera.width, world.camera.height);
    }
    for (int i = 0; i < kFramesInFlight; ++i) empty_.put(std::make_unique<SimulatedFrame>());
  }

  /// Each returns at the end of the duration, or soon after it is told to stop.
  void send_datagrams(const std::stop_token& stop);
  void render_frames(const std::stop_token& stop);
  void publish_frames(const std::stop_token& stop);

  DeviceCounts counts() const { return {frames_, skipped_, datagrams_}; }

 private:
  std::uint32_t first_in_time(std::uint32_t number, std::int64_t cost_ns) const;
  void publish(const SimulatedFrame& frame);

  const World* world_;
  double duration_s_;
  EndoscopeDevice endoscope_;
  TrackerLink tracker_;
  UdpSender sender_;
  std::function<bool()> tracking_;
  Bus bus_;
  Publisher<image_t> frames_out_;
  std::optional<V4l2Output> video_out_;  ///< instead of LCM
  image_t message_{};
  Handover<FramePointer> empty_;
  Handover<FramePointer> rendered_;
  std::atomic<std::uint64_t> frames_{0};
  std::atomic<std::uint64_t> skipped_{0};
  std::atomic<std::uint64_t> datagrams_{0};
};

void LiveDevices::send_datagrams(const std::stop_token& stop) {
  SimulatedDatagram datagram;
  for (tracker_.next(datagram); datagram.measured_s < duration_s_; tracker_.next(datagram)) {
    if (!sleep_until(datagram.arrival_ns, stop)) return;
    // What is not sent was counted all the same: the frame counter follows the synchronisation.
    if (tracking_ && !tracking_()) continue;
    if (sender_.send(datagram.bytes)) ++datagrams_;
  }
}

void LiveDevices::render_frames(const std::stop_token& stop) {
  std::int64_t cost_ns = 0;
  const double frames = duration_s_ * world_->options.camera_rate_hz;
  const auto end =
      frames < kEndlessFrames ? static_cast<std::uint32_t>(std::ceil(frames)) : kEndlessFrames;
  for (std::uint32_t number = 0; number < end; ++number) {
    auto frame = empty_.take(stop);
    if (!frame) return;
    const std::uint32_t in_time = std::min(first_in_time(number, cost_ns), end);
    skipped_ += in_time - number;
    number = in_time;
    if (number == end) break;
    if (!endoscope_.arrival_ns(number)) {
      empty_.put(std::move(*frame));
      continue;
    }
    const std::int64_t begin_ns = monotonic_ns();
    endoscope_.make(number, **frame);
    cost_ns = monotonic_ns() - begin_ns;
    rendered_.put(std::move(*frame));
  }
  rendered_.close();
}

/// The first frame from `number` on that can be ready when it is to arrive, or gets lost anyway.
std::uint32_t LiveDevices::first_in_time(std::uint32_t number, std::int64_t cost_ns) const {
  const std::int64_t ready_ns = monotonic_ns() + cost_ns;
  while (endoscope_.arrival_ns(number).value_or(ready_ns) < ready_ns) ++number;
  return number;
}

void LiveDevices::publish_frames(const std::stop_token& stop) {
  while (auto frame = rendered_.take(stop)) {
    if (!sleep_until((*frame)->arrival_ns, stop)) return;
    if (video_out_) {
      if (video_out_->show((*frame)->grey)) ++frames_;
    } else {
      publish(**frame);
    }
    empty_.put(std::move(*frame));
  }
}

void LiveDevices::publish(const SimulatedFrame& frame) {
  message_.timestamp_ns = frame.timestamp_ns;
  message_.frame_number = frame.number;
  message_.width = frame.grey.cols;
  message_.height = frame.grey.rows;
  message_.pixel_format = image_t::JPEG;
  message_.stride = 0;
  message_.size = static_cast<std::int32_t>(frame.jpeg.size());
  message_.data.assign(frame.jpeg.begin(), frame.jpeg.end());
  message_.num_features = 0;
  if (frames_out_.publish(message_)) ++frames_;
}

}  // namespace

DeviceCounts run_live(const World& world, double duration_s, const LiveOptions& options,
                      const std::function<bool()>& stopped) {
  LiveDevices devices(world, duration_s, options);
  std::atomic<int> running{3};
  const auto task = [&devices, &running](void (LiveDevices::*work)(const std::stop_token&)) {
    return std::jthread([&devices, &running, work](const std::stop_token& stop) {
      (devices.*work)(stop);
      --running;
    });
  };
  {
    std::jthread datagrams = task(&LiveDevices::send_datagrams);
    std::jthread rendering = task(&LiveDevices::render_frames);
    std::jthread publishing = task(&LiveDevices::publish_frames);
    while (running > 0 && !stopped()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }  // tells whichever still runs to stop, and waits for it
  return devices.counts();
}

}  // namespace handeye::simulator
