// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/scene.hpp"

#include <algorithm>
#include <iterator>

#include "daemon/reconstruction/appearances.hpp"
#include "daemon/reconstruction/point_trust.hpp"

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
    if (is_new) tracks.push_back({.feature_id = seen.feature_id});
    auto& observations = tracks[static_cast<std::size_t>(entry->second)].observations;
    if (!observations.empty() && observations.back().keyframe == position) continue;
    observations.push_back({position, pixel, *ray, true});
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
  drop_empty_tracks();
}

void Scene::drop_empty_tracks() {
  std::vector<int> position(tracks.size(), -1);
  int kept = 0;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (tracks[i].observations.empty()) continue;
    position[i] = kept;
    if (static_cast<std::size_t>(kept) != i) {
      tracks[static_cast<std::size_t>(kept)] = std::move(tracks[i]);
    }
    ++kept;
  }
  tracks.resize(static_cast<std::size_t>(kept));
  const auto moved = [&position](int track) { return position[static_cast<std::size_t>(track)]; };
  std::erase_if(track_of_feature_, [&](auto& entry) { return moved(entry.second) < 0; });
  for (auto& [feature_id, track] : track_of_feature_) track = moved(track);
  for (Keyframe& keyframe : keyframes) {
    for (int& track : keyframe.tracks) track = moved(track);
    std::erase(keyframe.tracks, -1);
  }
}

int Scene::track_of(std::int64_t feature_id) const {
  const auto entry = track_of_feature_.find(feature_id);
  return entry != track_of_feature_.end() ? entry->second : -1;
}

bool Scene::link(std::int64_t feature_id, int track) {
  const auto [entry, is_new] = track_of_feature_.try_emplace(feature_id, track);
  if (is_new || entry->second == track) return true;
  const int own_position = entry->second;
  Track& own = tracks[static_cast<std::size_t>(own_position)];
  Track& joined = tracks[static_cast<std::size_t>(track)];
  const auto by_keyframe = [](const TrackObservation& a, const TrackObservation& b) {
    return a.keyframe < b.keyframe;
  };
  std::vector<TrackObservation> both;
  std::merge(joined.observations.begin(), joined.observations.end(), own.observations.begin(),
             own.observations.end(), std::back_inserter(both), by_keyframe);
  const auto twice = std::adjacent_find(both.begin(), both.end(), [](const auto& a, const auto& b) {
    return a.keyframe == b.keyframe;
  });
  if (twice != both.end()) return false;
  for (const TrackObservation& seen : own.observations) {
    auto& listed = keyframes[static_cast<std::size_t>(seen.keyframe)].tracks;
    std::replace(listed.begin(), listed.end(), own_position, track);
  }
  joined.observations = std::move(both);
  own.observations.clear();
  own.has_point = false;
  for (auto& [id, position] : track_of_feature_) {
    if (position == own_position) position = track;
  }
  return true;
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

void Scene::note_appearances(int keyframe, const Appearances& appearances) {
  for (const int position : keyframes[static_cast<std::size_t>(keyframe)].tracks) {
    Track& track = tracks[static_cast<std::size_t>(position)];
    if (track.appearance) continue;
    const AppearanceBits* bits = appearances.find(track.feature_id);
    if (bits != nullptr) track.appearance = *bits;
  }
}

void Scene::find_matches(const FrameRecord& frame, std::vector<PointMatch>& matches) const {
  matches.clear();
  for (const FrameObservation& seen : frame.observations) {
    const auto entry = track_of_feature_.find(seen.feature_id);
    if (entry == track_of_feature_.end()) continue;
    const Track& track = tracks[static_cast<std::size_t>(entry->second)];
    if (!track.has_point) continue;
    matches.push_back({track.point_scene, {seen.x, seen.y}, trust_weight(track), entry->second});
  }
}

int Scene::point_count() const {
  return static_cast<int>(std::count_if(tracks.begin(), tracks.end(),
                                        [](const Track& track) { return track.has_point; }));
}

}  // namespace handeye
