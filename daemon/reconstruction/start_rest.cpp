// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/start_rest.hpp"

#include <algorithm>

#include "daemon/reconstruction/two_view.hpp"

namespace handeye {
namespace {

/// Fewer contradicting features, or a smaller share of all, are mistakes of the tracker.
constexpr std::size_t kFewestRest = 8;
constexpr double kMinRestShare = 0.12;
constexpr double kTurningRatio = 0.5;
/// Contradicted by more than this share, a scene is not what most of the picture shows.
constexpr double kMostContradicting = 0.4;
/// Least share of the features with a point: over the whole scene, and over half of it, where the
/// parallax of many is still too small. What has no parallax might be turned past, not moved past.
constexpr double kMinExplained = 0.5;
constexpr double kMinExplainedHalf = 0.35;

bool explained(const Track& track) {
  const auto inliers = std::count_if(track.observations.begin(), track.observations.end(),
                                     [](const auto& seen) { return seen.inlier; });
  return track.has_point && 2 * inliers > static_cast<std::ptrdiff_t>(track.observations.size());
}

const TrackObservation* seen_in(const Track& track, int keyframe) {
  const auto seen =
      std::find_if(track.observations.begin(), track.observations.end(),
                   [keyframe](const auto& other) { return other.keyframe == keyframe; });
  return seen != track.observations.end() ? &*seen : nullptr;
}

/// The same between two keyframes, over the features that both show.
bool contradicted_between(const Scene& scene, int first, int second, double min_explained,
                          double threshold_rad) {
  const Pose second_from_first =
      scene.keyframes[static_cast<std::size_t>(second)].eye_from_scene *
      scene.keyframes[static_cast<std::size_t>(first)].eye_from_scene.inverse();
  std::vector<RayPair> rest;
  std::size_t common = 0;
  std::size_t with_point = 0;
  for (const Track& track : scene.tracks) {
    const TrackObservation* in_first = seen_in(track, first);
    const TrackObservation* in_second = seen_in(track, second);
    if (in_first == nullptr || in_second == nullptr) continue;
    ++common;
    const RayPair pair{in_first->ray, in_second->ray};
    if (explained(track)) {
      ++with_point;
    } else if (epipolar_distance(second_from_first, pair) > threshold_rad) {
      rest.push_back(pair);
    }
  }
  if (static_cast<double>(with_point) < min_explained * static_cast<double>(common)) return true;
  const double share =
      static_cast<double>(rest.size()) / static_cast<double>(std::max<std::size_t>(1, common));
  if (rest.size() < kFewestRest || share < kMinRestShare) return false;
  if (share > kMostContradicting) return true;
  return fit_rotation(rest, threshold_rad).inlier_ratio > kTurningRatio;
}

}  // namespace

bool contradicted(const Scene& scene, double threshold_rad) {
  const auto last = static_cast<int>(scene.keyframes.size()) - 1;
  const int middle = last / 2;
  return contradicted_between(scene, 0, last, kMinExplained, threshold_rad) ||
         contradicted_between(scene, 0, middle, kMinExplainedHalf, threshold_rad) ||
         contradicted_between(scene, middle, last, kMinExplainedHalf, threshold_rad);
}

}  // namespace handeye
