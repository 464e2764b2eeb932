// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/one_step_problem.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "daemon/geometry/median.hpp"
#include "daemon/sync/hand_smoothing.hpp"

namespace handeye {
namespace {

constexpr std::int64_t kLongestReach_ns = 60'000'000;

std::optional<HandAtFrame> hand_at(std::int64_t timestamp_ns, const HandSmoothing& hand) {
  auto found = hand.at(timestamp_ns);
  if (!found) return std::nullopt;
  return HandAtFrame{.room_from_hand = found->room_from_hand,
                     .angular_velocity = found->angular_velocity,
                     .velocity = found->velocity,
                     .sample = found->sample,
                     .shares = std::move(found->shares),
                     .sample_covariance = found->sample_covariance};
}

/// One and a half periods of the frames, as far as a hand may be smoothed over.
std::int64_t reach_ns(const std::vector<RegisteredFrame>& frames) {
  std::vector<double> periods_ns;
  for (std::size_t k = 1; k < frames.size(); ++k) {
    periods_ns.push_back(static_cast<double>(frames[k].timestamp_ns - frames[k - 1].timestamp_ns));
  }
  return std::min(static_cast<std::int64_t>(1.5 * median(std::move(periods_ns))), kLongestReach_ns);
}

bool is_placed_by_what_it_saw(const RegisteredFrame& frame) {
  return frame.keyframe || !frame.unit_covariance.isZero(0.0);
}

/// A point that a frame saw twice, as where two tracks were joined, counts once there.
OneStepPoint to_point(const ScenePoint& point) {
  OneStepPoint result{.part = point.part, .point_scene = point.point_scene};
  result.observations.reserve(point.observations.size());
  for (const ScenePoint::Observation& seen : point.observations) {
    result.observations.push_back({seen.frame, seen.pixel});
  }
  constexpr auto frame_of = &OneStepPoint::Observation::frame;
  std::ranges::stable_sort(result.observations, {}, frame_of);
  const auto again = std::ranges::unique(result.observations, {}, frame_of);
  result.observations.erase(again.begin(), again.end());
  return result;
}

}  // namespace

HandSmoothing smoothed_for(const std::vector<RegisteredFrame>& frames, const PoseBuffer& hand) {
  return HandSmoothing(hand, {.reach_ns = reach_ns(frames)});
}

OneStepProblem one_step_problem(const Reconstruction& reconstruction, const HandSmoothing& hand,
                                double time_offset_s) {
  const auto offset_ns = static_cast<std::int64_t>(std::llround(1e9 * time_offset_s));
  OneStepProblem problem{.camera = reconstruction.lens.camera};
  problem.frames.reserve(reconstruction.frames.size());
  for (const RegisteredFrame& frame : reconstruction.frames) {
    OneStepFrame& one =
        problem.frames.emplace_back(OneStepFrame{.eye_from_scene = frame.eye_from_scene,
                                                 .part = frame.part,
                                                 .keyframe = frame.keyframe,
                                                 .unit_covariance = frame.unit_covariance});
    if (is_placed_by_what_it_saw(frame)) one.hand = hand_at(frame.timestamp_ns - offset_ns, hand);
  }
  problem.points.reserve(reconstruction.structure.size());
  for (const ScenePoint& point : reconstruction.structure) {
    problem.points.push_back(to_point(point));
  }
  return problem;
}

}  // namespace handeye
