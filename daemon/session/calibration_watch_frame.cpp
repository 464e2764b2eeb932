// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/calibration_watch_frame.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "daemon/session/calibration_watch_points.hpp"

namespace handeye {
namespace {

/// Of a ray, as far as the eye is off, beside which a scene's depth is known beforehand: points
/// that were laid by less are laid before the lens.
constexpr double kPlaceNoise = 0.005;

/// An interpolated pose is better than a sample (docs/math.md section 8).
double variance_factor(double fraction) {
  return (1.0 - fraction) * (1.0 - fraction) + fraction * fraction;
}

Matrix6d isotropic(const WatchHandNoise& noise) {
  Vector6d variance;
  variance.head<3>().setConstant(noise.rotation_rad * noise.rotation_rad);
  variance.tail<3>().setConstant(noise.translation_mm * noise.translation_mm);
  return variance.asDiagonal();
}

}  // namespace

WatchFrame make_watch_frame(const CameraModel& camera, const TrackedFrame& frame,
                            const HandLookup& hand, const WatchHandNoise& noise) {
  WatchFrame made{.timestamp_ns = frame.timestamp_ns,
                  .room_from_hand = hand.room_from_hand,
                  .angular_velocity = hand.room_from_hand.linear() * hand.angular_velocity,
                  .velocity = hand.velocity};
  made.hand_covariance =
      variance_factor(hand.fraction) * hand.sample_covariance.value_or(isotropic(noise));
  made.rays.reserve(frame.observations.size());
  for (const Observation& seen : frame.observations) {
    if (const auto ray = unproject(camera, seen.pixel)) {
      made.rays.push_back({seen.feature_id, *ray});
    }
  }
  return made;
}

std::vector<WatchTrack> watch_tracks(std::span<const WatchFrame> frames, std::size_t min_sights,
                                     std::size_t most_sights) {
  std::map<std::int64_t, WatchTrack> by_feature;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    for (const WatchRay& seen : frames[k].rays) {
      by_feature[seen.feature_id].sights.push_back({static_cast<int>(k), seen.ray});
    }
  }
  std::vector<WatchTrack> tracks;
  for (auto& [feature_id, track] : by_feature) {
    if (track.sights.size() >= min_sights) tracks.push_back(std::move(track));
  }
  std::ranges::stable_sort(tracks, std::ranges::greater{},
                           [](const WatchTrack& track) { return track.sights.size(); });
  std::size_t sights = 0;
  const auto too_many = std::ranges::find_if(tracks, [&](const WatchTrack& track) {
    return (sights += track.sights.size()) > most_sights;
  });
  tracks.erase(too_many, tracks.end());
  return tracks;
}

void place_points(std::span<const Pose> room_from_eye, std::vector<WatchTrack>& tracks) {
  for (WatchTrack& track : tracks) {
    const WatchTrack::Sight& middle = track.sights[track.sights.size() / 2];
    track.anchor = middle.frame;
    track.room_from_anchor = room_from_eye[static_cast<std::size_t>(middle.frame)];
    // u x (a + rho b) = 0 in every frame is linear in the inverse depth rho.
    const WatchDepth depth;
    const double known = std::pow(kPlaceNoise / depth.sigma, 2);
    double normal = known;
    double right = known * depth.usual;
    for (const WatchTrack::Sight& sight : track.sights) {
      const Pose& pose = room_from_eye[static_cast<std::size_t>(sight.frame)];
      const Eigen::Vector3d a =
          pose.linear().transpose() * (track.room_from_anchor.linear() * middle.ray.homogeneous());
      const Eigen::Vector3d b =
          pose.linear().transpose() * (track.room_from_anchor.translation() - pose.translation());
      const Eigen::Vector2d by_depth = b.head<2>() - sight.ray * b.z();
      const Eigen::Vector2d apart = a.head<2>() - sight.ray * a.z();
      normal += by_depth.squaredNorm();
      right -= by_depth.dot(apart);
    }
    track.point << middle.ray, std::clamp(right / normal, depth.least, depth.largest);
  }
}

}  // namespace handeye
