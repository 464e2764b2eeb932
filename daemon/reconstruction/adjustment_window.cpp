// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/adjustment_window.hpp"

#include <algorithm>

#include "daemon/reconstruction/point_trust.hpp"

namespace handeye {
namespace {

/// The track as the window sees it: its inliers there, counted from the window's first keyframe.
Track cut_track(const Track& track, int first_keyframe) {
  Track cut{.feature_id = track.feature_id};
  for (TrackObservation seen : track.observations) {
    if (!seen.inlier || seen.keyframe < first_keyframe) continue;
    seen.keyframe -= first_keyframe;
    cut.observations.push_back(seen);
  }
  cut.has_point = true;
  cut.point_scene = track.point_scene;
  return cut;
}

}  // namespace

AdjustmentWindow cut_window(const CameraModel& camera, const AdjustmentOptions& options,
                            const Scene& scene) {
  AdjustmentWindow window;
  window.camera = camera;
  window.first_keyframe = std::max(0, options.first_variable - options.max_fixed);
  window.options = options;
  window.options.first_variable -= window.first_keyframe;
  for (auto k = static_cast<std::size_t>(window.first_keyframe); k < scene.keyframes.size(); ++k) {
    const Keyframe& keyframe = scene.keyframes[k];
    window.scene.keyframes.push_back(
        {.frame_index = keyframe.frame_index, .eye_from_scene = keyframe.eye_from_scene});
  }
  for (std::size_t i = 0; i < scene.tracks.size(); ++i) {
    const Track& track = scene.tracks[i];
    if (!track.has_point || track.observations.empty() || !is_trusted(track)) continue;
    if (track.observations.back().keyframe < options.first_variable) continue;
    Track cut = cut_track(track, window.first_keyframe);
    if (cut.observations.size() < 2) continue;
    window.scene.tracks.push_back(std::move(cut));
    window.tracks.push_back(static_cast<int>(i));
  }
  return window;
}

void adjust(AdjustmentWindow& window) {
  adjust(window.camera, window.options, window.scene);
}

void take_over(const AdjustmentWindow& window, Scene& scene) {
  for (std::size_t k = 0; k < window.scene.keyframes.size(); ++k) {
    scene.keyframes[static_cast<std::size_t>(window.first_keyframe) + k].eye_from_scene =
        window.scene.keyframes[k].eye_from_scene;
  }
  for (std::size_t i = 0; i < window.tracks.size(); ++i) {
    Track& track = scene.tracks[static_cast<std::size_t>(window.tracks[i])];
    if (track.has_point) track.point_scene = window.scene.tracks[i].point_scene;
  }
}

}  // namespace handeye
