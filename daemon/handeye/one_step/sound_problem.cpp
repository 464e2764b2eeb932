// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/one_step/sound_problem.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "daemon/handeye/usable.hpp"

namespace handeye {
namespace {

/// The shares of samples in one hand; they add up to it.
bool is_share_of_samples(const std::vector<double>& shares) {
  double sum = 0;
  for (const double share : shares) sum += share;
  return std::abs(sum - 1.0) < 1e-6;
}

bool is_finite(const OneStepFrame& frame) {
  if (!is_usable(frame.eye_from_scene) || !frame.unit_covariance.allFinite()) return false;
  if (!frame.hand) return true;
  const HandAtFrame& hand = *frame.hand;
  return is_usable(hand.room_from_hand) && hand.angular_velocity.allFinite() &&
         hand.velocity.allFinite() && is_share_of_samples(hand.shares) &&
         (!hand.sample_covariance || hand.sample_covariance->allFinite());
}

}  // namespace

bool is_sound(const OneStepProblem& problem) {
  if (problem.camera.problem()) return false;
  if (!std::ranges::all_of(problem.frames, is_finite)) return false;
  return std::ranges::all_of(problem.points, [&](const OneStepPoint& point) {
    return point.point_scene.allFinite() &&
           std::ranges::all_of(point.observations,
                               [&](const OneStepPoint::Observation& seen) {
                                 if (seen.frame < 0 || !seen.pixel.allFinite()) return false;
                                 const auto at = static_cast<std::size_t>(seen.frame);
                                 return at < problem.frames.size() && problem.frames[at].keyframe &&
                                        problem.frames[at].part == point.part;
                               }) &&
           std::ranges::is_sorted(point.observations, std::ranges::less_equal{},
                                  &OneStepPoint::Observation::frame);
  });
}

}  // namespace handeye
