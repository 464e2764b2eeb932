// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "drivers/simulator/endoscope_view.hpp"
#include "drivers/simulator/frame_delivery.hpp"
#include "drivers/simulator/world.hpp"

namespace handeye::simulator {

/// Frames stay below this so that an LCM message of one stays below 100 kB.
inline constexpr std::size_t kLargestJpegBytes = 99'000;

/// One camera image and the truth behind it.
struct SimulatedFrame {
  std::uint32_t number{0};       ///< the camera's count
  double exposed_s{0};           ///< simulated time of mid-exposure
  std::int64_t timestamp_ns{0};  ///< host clock, as the grabber stamps it: the camera's delay late
  std::int64_t arrival_ns{0};    ///< host clock, when software gets it; of a lost one, its stamp
  cv::Mat grey;                  ///< CV_8UC1
  std::vector<std::uint8_t> jpeg;
};

/// The camera on the scope. Any frame can be made at any time, in any order, and looks the same.
/// One thread an object; several may share the world, which must outlive them.
class EndoscopeDevice {
 public:
  explicit EndoscopeDevice(const World& world);

  /// Simulated time of a frame's mid-exposure, and the host time of its stamp.
  double exposure_s(std::uint32_t number) const;
  std::int64_t timestamp_ns(std::uint32_t number) const;

  /// When software gets a frame, host clock; later frames never earlier. Nothing: it gets lost.
  std::optional<std::int64_t> arrival_ns(std::uint32_t number) const;

  /// Renders and encodes a frame, also one that would get lost; its memory is reused.
  void make(std::uint32_t number, SimulatedFrame& frame);

 private:
  void encode(SimulatedFrame& frame) const;

  const World* world_;
  EndoscopeView view_;
  FrameDelivery delivery_;
};

}  // namespace handeye::simulator
