// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/relocalisation.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "daemon/reconstruction/point_trust.hpp"
#include "daemon/tracking/hamming_distance.hpp"

namespace handeye {
namespace {

/// Bits of 256; the same spot seen again differs by 20 to 60, different spots by 128 +- 15.
constexpr int kSameAnywhere = 70;
constexpr double kClearlyNearer = 0.8;
constexpr int kSameHere = 80;
constexpr double kSecondLookPx = 8.0;
constexpr int kFewestRecognised = 20;
/// Share of the features recognised anywhere that must agree on a pose.
constexpr double kFewestRight = 0.15;
/// Rms of what was recognised over the root of how many: how far the join may be off. Where corners
/// are found beside their old points it is 0.2 px, and a part that goes on from there comes out
/// bent by up to 0.8 deg, which is worse than two parts; where the same spots are found, 0.1 px.
constexpr double kMostJoinErrorPx = 0.13;

bool holds_together(const Resection& join) {
  return join.reprojection_px <= kMostJoinErrorPx * std::sqrt(join.inliers);
}

bool is_candidate(const Track& track) {
  return track.has_point && track.appearance && is_trusted(track);
}

/// Keeps for each track the feature nearest to it.
class BestOfTrack {
 public:
  void offer(std::int64_t feature_id, int track, double distance) {
    const auto [entry, is_new] = best_.try_emplace(track, Offer{feature_id, distance});
    if (!is_new && distance < entry->second.distance) entry->second = {feature_id, distance};
  }
  std::vector<Recognition> all() const {
    std::vector<Recognition> found;
    found.reserve(best_.size());
    for (const auto& [track, offer] : best_) found.push_back({offer.feature_id, track});
    std::sort(found.begin(), found.end(),
              [](const auto& a, const auto& b) { return a.feature_id < b.feature_id; });
    return found;
  }

 private:
  struct Offer {
    std::int64_t feature_id;
    double distance;
  };
  std::unordered_map<int, Offer> best_;
};

std::vector<Recognition> recognise_anywhere(const FrameRecord& frame,
                                            const Appearances& appearances, const Scene& scene) {
  std::vector<int> candidates;
  for (std::size_t i = 0; i < scene.tracks.size(); ++i) {
    if (is_candidate(scene.tracks[i])) candidates.push_back(static_cast<int>(i));
  }
  BestOfTrack best;
  for (const FrameObservation& seen : frame.observations) {
    const AppearanceBits* bits = appearances.find(seen.feature_id);
    if (bits == nullptr) continue;
    int nearest = kSameAnywhere;
    int second = 256;
    int track = -1;
    for (const int candidate : candidates) {
      const int distance =
          hamming_distance(*bits, *scene.tracks[static_cast<std::size_t>(candidate)].appearance);
      if (distance < nearest) {
        second = track >= 0 ? nearest : second;
        nearest = distance;
        track = candidate;
      } else {
        second = std::min(second, distance);
      }
    }
    if (track >= 0 && nearest < kClearlyNearer * second) {
      best.offer(seen.feature_id, track, nearest);
    }
  }
  return best.all();
}

std::vector<PointMatch> to_matches(const std::vector<Recognition>& recognised,
                                   const FrameRecord& frame, const Scene& scene) {
  std::vector<PointMatch> matches;
  auto seen = frame.observations.begin();
  for (const Recognition& found : recognised) {
    while (seen->feature_id < found.feature_id) ++seen;
    const Track& track = scene.tracks[static_cast<std::size_t>(found.track)];
    matches.push_back({track.point_scene, {seen->x, seen->y}, 1.0, found.track});
  }
  return matches;
}

/// Points that the frame does not show by any of its features, where the pose puts them.
struct Expected {
  int track;
  Eigen::Vector2d pixel;
};

std::vector<Expected> expected_points(const CameraModel& camera, const Pose& eye_from_scene,
                                      const FrameRecord& frame, const Scene& scene) {
  std::vector<bool> shown(scene.tracks.size(), false);
  for (const FrameObservation& seen : frame.observations) {
    const int track = scene.track_of(seen.feature_id);
    if (track >= 0) shown[static_cast<std::size_t>(track)] = true;
  }
  std::vector<Expected> expected;
  for (std::size_t i = 0; i < scene.tracks.size(); ++i) {
    const Track& track = scene.tracks[i];
    if (shown[i] || !is_candidate(track)) continue;
    const Eigen::Vector3d point_eye = eye_from_scene * track.point_scene;
    if (!(point_eye.z() > 0)) continue;
    const Eigen::Vector2d pixel = project<double>(camera, point_eye);
    if (pixel.x() < 0 || pixel.y() < 0 || pixel.x() >= camera.width || pixel.y() >= camera.height) {
      continue;
    }
    expected.push_back({static_cast<int>(i), pixel});
  }
  return expected;
}

}  // namespace

std::vector<Recognition> recognise_near(const CameraModel& camera, const Pose& eye_from_scene,
                                        const FrameRecord& frame, const Appearances& appearances,
                                        double radius_px, const Scene& scene) {
  const auto expected = expected_points(camera, eye_from_scene, frame, scene);
  BestOfTrack best;
  for (const FrameObservation& seen : frame.observations) {
    const int own = scene.track_of(seen.feature_id);
    if (own >= 0 && scene.tracks[static_cast<std::size_t>(own)].has_point) continue;
    const AppearanceBits* bits = appearances.find(seen.feature_id);
    if (bits == nullptr) continue;
    double nearest_px = radius_px;
    int track = -1;
    for (const Expected& point : expected) {
      const double distance_px = (point.pixel - Eigen::Vector2d(seen.x, seen.y)).norm();
      if (distance_px >= nearest_px) continue;
      const auto& its = *scene.tracks[static_cast<std::size_t>(point.track)].appearance;
      if (hamming_distance(*bits, its) > kSameHere) continue;
      nearest_px = distance_px;
      track = point.track;
    }
    if (track >= 0) best.offer(seen.feature_id, track, nearest_px);
  }
  return best.all();
}

std::optional<Relocalisation> relocalise(const CameraModel& camera, const FrameRecord& frame,
                                         const Appearances& appearances,
                                         const ResectionOptions& options, const Scene& scene) {
  const auto guessed = recognise_anywhere(frame, appearances, scene);
  ResectionOptions lenient = options;
  lenient.min_inlier_ratio = kFewestRight;
  const auto rough = resect(camera, to_matches(guessed, frame, scene), Pose::Identity(), lenient);
  if (!rough) return std::nullopt;
  Relocalisation found;
  found.recognised =
      recognise_near(camera, rough->eye_from_scene, frame, appearances, kSecondLookPx, scene);
  if (static_cast<int>(found.recognised.size()) < kFewestRecognised) return std::nullopt;
  ResectionOptions strict = options;
  strict.min_inliers = kFewestRecognised;
  const auto sure = refine_pose(camera, to_matches(found.recognised, frame, scene),
                                rough->eye_from_scene, strict);
  if (!sure || !holds_together(*sure)) return std::nullopt;
  found.eye_from_scene = sure->eye_from_scene;
  return found;
}

}  // namespace handeye
