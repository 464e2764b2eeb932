// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/scene.hpp"

#include <algorithm>

namespace handeye {

void Scene::add_keyframe(const CameraModel& camera, const FrameRecord& frame,
                         const Pose& eye_from_scene, double travel_px) {
  const int position = static_cast<int>(keyframes.size());
  Keyframe keyframe;
  keyframe.frame_index = frame.index;
  keyframe.eye_from_scene = eye_from_scene;
  keyframe.travel_px = travel_px;
  keyframe.tracks.reserve(frame.observations.size());
  for (const FrameObservation& seen : frame.observations) {
    const Eigen::Vector2d pixel(seen.x, seen.y);
    const auto ray = unproject(camera, pixel);
    if (!ray) continue;
    const auto [entry, is_new] =
        track_of_feature_.try_emplace(seen.feature_id, static_cast<int>(tracks.size()));
    if (is_new) tracks.push_back({seen.feature_id, {}, false, Eigen::Vector3d::Zero()});
    tracks[static_cast<std::size_t>(entry->second)].observations.push_back(
        {position, pixel, *ray, true});
    keyframe.tracks.push_back(entry->second);
  }
  keyframes.push_back(std::move(keyframe));
}

void Scene::remove_keyframe(int keyframe) {
  for (Track& track : tracks) {
    std::erase_if(track.observations,
                  [keyframe](const TrackObservation& seen) { return seen.keyframe == keyframe; });
    for (TrackObservation& seen : track.observations) {
      if (seen.keyframe > keyframe) --seen.keyframe;
    }
  }
  keyframes.erase(keyframes.begin() + keyframe);
}

void Scene::refresh_rays(const CameraModel& camera) {
  for (Track& track : tracks) {
    std::erase_if(track.observations, [&camera](TrackObservation& seen) {
      const auto ray = unproject(camera, seen.pixel);
      if (ray) seen.ray = *ray;
      return !ray;
    });
  }
}

void Scene::find_matches(const FrameRecord& frame, std::vector<PointMatch>& matches) const {
  matches.clear();
  for (const FrameObservation& seen : frame.observations) {
    const auto entry = track_of_feature_.find(seen.feature_id);
    if (entry == track_of_feature_.end()) continue;
    const Track& track = tracks[static_cast<std::size_t>(entry->second)];
    if (track.has_point) matches.push_back({track.point_scene, {seen.x, seen.y}});
  }
}

int Scene::point_count() const {
  return static_cast<int>(std::count_if(tracks.begin(), tracks.end(),
                                        [](const Track& track) { return track.has_point; }));
}

}  // namespace handeye
