// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "drivers/simulator/disturbance.hpp"

namespace handeye::simulator {

/// What becomes of a frame on its way to us.
struct FrameFate {
  bool missing{false};     ///< never arrives; its number is a gap
  bool dark{false};        ///< the light was off
  std::uint32_t shown{0};  ///< the frame whose picture it carries: an earlier one where frozen
  bool frozen(std::uint32_t number) const { return shown != number; }
};

/// Decides for every frame, in any order, from the seed alone.
class FrameFates {
 public:
  FrameFates(const Disturbances& disturbances, std::uint64_t seed, double camera_rate_hz);

  FrameFate of(std::uint32_t number) const;

 private:
  bool is_missing(std::uint32_t number) const;

  Disturbances disturbances_;
  std::uint64_t seed_;
  double camera_rate_hz_;
  double frames_per_gap_;
};

}  // namespace handeye::simulator
