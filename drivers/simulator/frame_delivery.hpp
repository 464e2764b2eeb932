// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "drivers/simulator/world.hpp"

namespace handeye::simulator {

/// When a frame is stamped and when software gets it, as the world's faults of the camera say. In
/// any order. The world must outlive it.
class FrameDelivery {
 public:
  explicit FrameDelivery(const World& world) : world_(&world) {}

  /// The grabber's stamp of a frame exposed at this time, host clock: the camera's delay late, and
  /// wrong after a jump of the stamps.
  std::int64_t timestamp_ns(double exposed_s) const;

  /// When software gets it, host clock; nothing: never, the grabber's buffers were full.
  std::optional<std::int64_t> arrival_ns(double exposed_s) const;

 private:
  const World* world_;
};

}  // namespace handeye::simulator
