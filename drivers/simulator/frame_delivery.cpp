// SPDX-License-Identifier: BSD-3-Clause
#include "drivers/simulator/frame_delivery.hpp"

#include <algorithm>
#include <cmath>

namespace handeye::simulator {
namespace {

/// From the end of the camera's delay to the program that wants the frame.
constexpr std::int64_t kDeliveryNs = 2'000'000;

/// So many frames wait while nobody takes them.
constexpr double kBuffers = 4;

/// A frame exposed as the stall begins is its first, whatever the last bits say.
constexpr double kRounding = 1e-6;

/// Held-back frames are taken one upon the other.
constexpr std::int64_t kBetweenHeldNs = 1'000'000;

}  // namespace

std::int64_t FrameDelivery::timestamp_ns(double exposed_s) const {
  return world_->host_ns(exposed_s + world_->camera_delay_s +
                         sum_until(world_->camera_faults, FaultKind::kStampJump, exposed_s));
}

std::optional<std::int64_t> FrameDelivery::arrival_ns(double exposed_s) const {
  const std::int64_t usual_ns = world_->host_ns(exposed_s + world_->camera_delay_s) + kDeliveryNs;
  const auto end_s = interval_end_s(world_->camera_faults, FaultKind::kStall, exposed_s);
  if (!end_s) return usual_ns;
  double begin_s = exposed_s;
  for (const Fault& fault : world_->camera_faults) {
    if (fault.kind == FaultKind::kStall && *fault.at_s <= exposed_s &&
        exposed_s < *fault.at_s + fault.amount) {
      begin_s = std::min(begin_s, *fault.at_s);
    }
  }
  const double place =
      std::floor((exposed_s - begin_s) * world_->options.camera_rate_hz + kRounding);
  if (place >= kBuffers) return std::nullopt;
  return world_->host_ns(*end_s + world_->camera_delay_s) + kDeliveryNs -
         std::llround((kBuffers - place) * kBetweenHeldNs);
}

}  // namespace handeye::simulator
