// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/offset_check.hpp"

#include <cmath>
#include <vector>

namespace handeye {
namespace {

// Either is reached by no drift that a calibration survives, nor by the correlation's own errors.
constexpr double kJump_s = 0.03;
constexpr double kJumpSigmas = 8.0;
constexpr double kSure = 0.5;  // of a confidence

}  // namespace

std::optional<TimeOffset> correlate(std::span<const RegisteredFrame> frames,
                                    const PoseBuffer& hand) {
  std::vector<EyeSample> eye;
  eye.reserve(frames.size());
  for (const RegisteredFrame& frame : frames) {
    eye.push_back({frame.timestamp_ns, frame.eye_from_scene, frame.part});
  }
  return correlate_angular_speed(hand, eye);
}

bool offset_jumped(std::span<const RegisteredFrame> frames, const PoseBuffer& hand) {
  const auto first = correlate(frames.first(frames.size() / 2), hand);
  if (!first || first->confidence < kSure) return false;
  const auto second = correlate(frames.subspan(frames.size() / 2), hand);
  if (!second || second->confidence < kSure) return false;
  const double jump_s = std::abs(second->time_offset_s - first->time_offset_s);
  return jump_s > kJump_s && jump_s > kJumpSigmas * std::hypot(first->sigma_s, second->sigma_s);
}

}  // namespace handeye
