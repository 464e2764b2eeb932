// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/estimate.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "daemon/handeye/parts.hpp"
#include "daemon/session/offset_check.hpp"
#include "daemon/session/stopwatch.hpp"

namespace handeye {
namespace {

// The likelihood is linear in the offset within a few milliseconds; look up again beyond this.
constexpr double kOffsetSettled_s = 0.0005;
constexpr int kMostRounds = 4;
// Longer than camera and tracker are apart in any set-up without a fault.
constexpr std::int64_t kRest_ns = 150'000'000;
// Of a difference of two poses, three axes each: passed by chance once in some thousands.
constexpr double kRestSigmas = 6.0;

/// Whether the hand was where it was at the frame for as long as an offset may reach, before and
/// after; frames at which it was not seen do not count.
bool rested_at(std::int64_t timestamp_ns, const PoseBuffer& hand, const PoseNoise& noise) {
  const HandLookup at_frame = hand.lookup(timestamp_ns);
  if (at_frame.status != LookupStatus::kOk) return true;
  return std::ranges::all_of(std::array{-kRest_ns, kRest_ns}, [&](std::int64_t shift_ns) {
    const HandLookup beside = hand.lookup(timestamp_ns + shift_ns);
    return beside.status == LookupStatus::kOk &&
           rotation_angle_rad(beside.room_from_hand.linear(), at_frame.room_from_hand.linear()) <
               kRestSigmas * noise.hand_rotation_rad &&
           (beside.room_from_hand.translation() - at_frame.room_from_hand.translation()).norm() <
               kRestSigmas * noise.hand_translation_mm;
  });
}

bool stood_still(std::span<const RegisteredFrame> frames, const PoseBuffer& hand,
                 const PoseNoise& noise) {
  return !frames.empty() && std::ranges::all_of(frames, [&](const RegisteredFrame& frame) {
    return rested_at(frame.timestamp_ns, hand, noise);
  });
}

}  // namespace

std::vector<HandEyeObservation> observe(std::span<const RegisteredFrame> frames,
                                        const PoseBuffer& hand, double time_offset_s) {
  std::vector<HandEyeObservation> observations;
  observations.reserve(frames.size());
  const auto offset_ns = static_cast<std::int64_t>(std::llround(1e9 * time_offset_s));
  for (const RegisteredFrame& frame : frames) {
    const HandLookup found = hand.lookup(frame.timestamp_ns - offset_ns);
    if (found.status != LookupStatus::kOk) continue;
    observations.push_back({.poses = {found.room_from_hand, frame.eye_from_scene},
                            .hand_angular_velocity = found.angular_velocity,
                            .hand_velocity = found.velocity,
                            .part = frame.part});
  }
  return observations;
}

std::vector<PosePair> poses_of_answer(const Estimate& estimate) {
  const std::vector<Part> parts = parts_of(estimate.observations);
  if (parts.empty()) return {};
  const auto of_answer = std::ranges::find_if(parts, [&](const Part& part) {
    return estimate.likelihood && part.number == estimate.likelihood->part;
  });
  return poses_of(estimate.observations, of_answer == parts.end() ? parts.front() : *of_answer);
}

Estimate estimate(std::span<const RegisteredFrame> frames, const PoseBuffer& hand,
                  const PoseNoise& noise, ScaleMode scale) {
  const Stopwatch stopwatch;
  Estimate result;
  result.scale = scale;
  result.correlation = correlate(frames, hand);
  if (result.correlation) {
    result.time_offset_s = result.correlation->time_offset_s;
    result.time_offset_sigma_s = result.correlation->sigma_s;
  } else {
    result.stood_still = stood_still(frames, hand, noise);
  }
  MaximumLikelihoodOptions& options = result.options;
  options.noise = noise;
  options.estimate_scale = scale == ScaleMode::kUnknown;
  // Without a correlation there was too little rotation to refine an offset either.
  options.estimate_time_offset = result.correlation.has_value();
  for (int round = 0; round < kMostRounds; ++round) {
    result.observations = observe(frames, hand, result.time_offset_s);
    result.likelihood = maximum_likelihood(result.observations, options);
    if (!result.likelihood || !options.estimate_time_offset) break;
    result.time_offset_s += result.likelihood->time_offset_correction_s;
    result.time_offset_sigma_s = result.likelihood->time_offset_sigma_s;
    if (std::abs(result.likelihood->time_offset_correction_s) < kOffsetSettled_s) break;
  }
  result.time_ms = stopwatch.elapsed_ms();
  return result;
}

}  // namespace handeye
