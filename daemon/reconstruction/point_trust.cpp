// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/point_trust.hpp"

#include <algorithm>

namespace handeye {
namespace {

// A point gains one a frame that it agrees with and loses two where it does not: one that is wrong
// in a third of all frames gets nowhere.
constexpr int kMostTrust = 20;
constexpr int kTrusted = 2;
constexpr int kLoss = 2;
constexpr int kRefused = -6;
constexpr int kProvingKeyframes = 3;
constexpr double kLeastWeight = 0.1;

bool agrees(const CameraModel& camera, const Pose& eye_from_scene, const PointMatch& match,
            double max_px) {
  const Eigen::Vector3d point_eye = eye_from_scene * match.point_scene;
  return point_eye.z() > 0 &&
         (project<double>(camera, point_eye) - match.pixel).squaredNorm() <= max_px * max_px;
}

}  // namespace

bool is_trusted(const Track& track) {
  if (track.trust < 0) return false;
  return track.trust >= kTrusted ||
         std::count_if(track.observations.begin(), track.observations.end(),
                       [](const auto& seen) { return seen.inlier; }) >= kProvingKeyframes;
}

double trust_weight(const Track& track) {
  if (is_trusted(track)) {
    return std::clamp(static_cast<double>(track.trust) / kMostTrust, 0.3, 1.0);
  }
  return kLeastWeight;
}

void update_trust(const CameraModel& camera, const Pose& eye_from_scene,
                  const std::vector<PointMatch>& matches, double max_px, Scene& scene) {
  for (const PointMatch& match : matches) {
    Track& track = scene.tracks[static_cast<std::size_t>(match.track)];
    if (agrees(camera, eye_from_scene, match, max_px)) {
      track.trust = std::min(track.trust + 1, kMostTrust);
      continue;
    }
    track.trust -= kLoss;
    if (track.trust <= kRefused) {
      track.refused = true;
      track.has_point = false;
    }
  }
}

void drop_distrusted_points(Scene& scene) {
  for (Track& track : scene.tracks) {
    if (track.trust < 0) track.has_point = false;
  }
}

}  // namespace handeye
