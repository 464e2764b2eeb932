// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/start_rest.hpp"

#include <algorithm>

#include "daemon/reconstruction/two_view.hpp"

namespace handeye {
namespace {

/// Fewer unexplained features, or a smaller share of all, are mistakes of the tracker.
constexpr std::size_t kFewestRest = 8;
constexpr double kMinRestShare = 0.12;
constexpr double kTurningRatio = 0.6;

bool explained(const Track& track) {
  const auto inliers = std::count_if(track.observations.begin(), track.observations.end(),
                                     [](const auto& seen) { return seen.inlier; });
  return track.has_point && 2 * inliers > static_cast<std::ptrdiff_t>(track.observations.size());
}

const Pose& pose_at(const Scene& scene, const TrackObservation& seen) {
  return scene.keyframes[static_cast<std::size_t>(seen.keyframe)].eye_from_scene;
}

}  // namespace

bool rest_only_turns(const Scene& scene, double threshold_rad) {
  const auto last = static_cast<int>(scene.keyframes.size()) - 1;
  std::vector<RayPair> rest;
  std::size_t whole = 0;
  for (const Track& track : scene.tracks) {
    if (track.observations.empty() || track.observations.front().keyframe != 0 ||
        track.observations.back().keyframe != last) {
      continue;
    }
    ++whole;
    if (explained(track)) continue;
    const TrackObservation& first = track.observations.front();
    const TrackObservation& second = track.observations.back();
    const Eigen::Matrix3d turn =
        pose_at(scene, second).linear() * pose_at(scene, first).linear().transpose();
    const Eigen::Vector2d turned = (turn * first.ray.homogeneous()).hnormalized();
    if ((turned - second.ray).norm() > 2.0 * threshold_rad) rest.push_back({first.ray, second.ray});
  }
  if (rest.size() < kFewestRest ||
      static_cast<double>(rest.size()) < kMinRestShare * static_cast<double>(whole)) {
    return false;
  }
  return fit_rotation(rest, threshold_rad).inlier_ratio > kTurningRatio;
}

}  // namespace handeye
