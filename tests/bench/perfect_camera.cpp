// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bench/perfect_camera.hpp"

#include <chrono>
#include <cmath>
#include <vector>

#include "daemon/session/hand_stream.hpp"
#include "daemon/sync/clock_hindsight.hpp"
#include "daemon/sync/hand_smoothing.hpp"
#include "drivers/recording/recording.hpp"

namespace handeye {
namespace {

PoseBuffer hand_of(const Recording& recording) {
  PoseBuffer buffer({.capacity = recording.datagrams.size()});
  HandStream stream(-1);
  for (const RecordedDatagram& datagram : recording.datagrams) {
    const auto sample = stream.take({datagram.arrival_ns, datagram.bytes});
    if (sample) buffer.push(*sample);
  }
  return with_hindsight(buffer);
}

std::vector<HandEyeObservation> observations_of(Recording& recording,
                                                const simulator::World& world) {
  const PoseBuffer hand = hand_of(recording);
  const HandSmoothing smoothing(hand);
  std::vector<HandEyeObservation> observations;
  if (recording.camera->open()) return observations;
  Frame frame;
  while (recording.camera->grab(frame, std::chrono::milliseconds(0)) == GrabStatus::kFrame) {
    const double exposed_s =
        1e-9 * static_cast<double>(frame.timestamp_ns - world.start_ns) - world.camera_delay_s;
    const auto offset_ns = static_cast<std::int64_t>(std::llround(1e9 * world.time_offset_s()));
    const auto found = smoothing.at(frame.timestamp_ns - offset_ns);
    if (!found) continue;
    HandEyeObservation& observation = observations.emplace_back();
    observation.poses = {found->room_from_hand, world.room_from_eye(exposed_s).inverse()};
    observation.hand_angular_velocity = found->angular_velocity;
    observation.hand_velocity = found->velocity;
  }
  return observations;
}

}  // namespace

std::optional<MaximumLikelihoodResult> answer_of_perfect_camera(
    const simulator::World& world, const std::filesystem::path& recording) {
  Recording opened = open_recording(recording);
  MaximumLikelihoodOptions options;
  options.noise = {.hand_rotation_rad = rad_from_deg(world.options.tracker_noise_deg),
                   .hand_translation_mm = world.options.tracker_noise_mm,
                   .eye_rotation_rad = 1e-7,
                   .eye_translation_mm = 1e-4};
  options.estimate_time_offset = true;
  return maximum_likelihood(observations_of(opened, world), options);
}

}  // namespace handeye
