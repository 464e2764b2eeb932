// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/record.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <limits>
#include <span>
#include <thread>
#include <vector>

#include "drivers/recording/recording.hpp"
#include "drivers/simulator/endoscope_device.hpp"
#include "drivers/simulator/tracker_link.hpp"
#include "drivers/simulator/truth_file.hpp"

namespace handeye::simulator {
namespace {

/// Makes frames in order, some at a time, one a core.
class FrameBatches {
 public:
  explicit FrameBatches(const World& world) : frames_(std::clamp(cores(), 1U, 8U)) {
    for (std::size_t i = 0; i < frames_.size(); ++i) devices_.emplace_back(world);
  }

  /// The next frames that arrive, from number `next` up to but without `end`; `next` moves on.
  std::span<const SimulatedFrame> make(std::uint32_t& next, std::uint32_t end) {
    std::vector<std::future<void>> pending;
    for (; pending.size() < frames_.size() && next < end; ++next) {
      if (!devices_.front().arrival_ns(next)) continue;
      pending.push_back(std::async(std::launch::async, [this, number = next, i = pending.size()] {
        devices_[i].make(number, frames_[i]);
      }));
    }
    for (std::future<void>& result : pending) result.get();
    return {frames_.data(), pending.size()};
  }

 private:
  static unsigned cores() { return std::thread::hardware_concurrency(); }

  std::vector<EndoscopeDevice> devices_;
  std::vector<SimulatedFrame> frames_;
};

}  // namespace

std::filesystem::path truth_path_of(const std::filesystem::path& recording) {
  if (recording.extension() != ".lcm") return recording / "truth.json";
  std::filesystem::path path = recording;
  return path.replace_extension(".truth.json");
}

DeviceCounts record(const World& world, double duration_s, const std::filesystem::path& path) {
  FrameBatches batches(world);  // first: a lens it cannot draw must not leave half a recording
  const auto writer = create_recording(path, world.camera);
  write_truth(truth_path_of(path), world);

  DeviceCounts counts;
  TrackerLink tracker(world);
  SimulatedDatagram datagram;
  tracker.next(datagram);
  const auto write_datagrams_until = [&](std::int64_t until_ns) {
    while (datagram.measured_s < duration_s && datagram.arrival_ns <= until_ns) {
      writer->write_datagram(datagram.arrival_ns, datagram.bytes);
      ++counts.datagrams;
      tracker.next(datagram);
    }
  };

  const auto frames =
      static_cast<std::uint32_t>(std::ceil(duration_s * world.options.camera_rate_hz));
  for (std::uint32_t next = 0; next < frames;) {
    for (const SimulatedFrame& frame : batches.make(next, frames)) {
      write_datagrams_until(frame.arrival_ns);
      writer->write_frame(frame.timestamp_ns, frame.arrival_ns, frame.number, world.camera.width,
                          world.camera.height, frame.jpeg);
      ++counts.frames;
    }
  }
  write_datagrams_until(std::numeric_limits<std::int64_t>::max());
  writer->close();
  return counts;
}

}  // namespace handeye::simulator
