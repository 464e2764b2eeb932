// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/geometry/camera_model.hpp"
#include "daemon/reconstruction/scene.hpp"

namespace handeye {

struct PointOptions {
  double max_reprojection_px{2.0};
  double min_triangulation_deg{2.0};
};

/// Gives points to the tracks of a keyframe that have none and now show enough parallax.
/// Observations that do not fit are marked as outliers. Returns how many points were won.
int triangulate_tracks(const CameraModel& camera, const PointOptions& options, int keyframe,
                       Scene& scene);

/// The same over all tracks of the scene, each once.
int triangulate_all(const CameraModel& camera, const PointOptions& options, Scene& scene);

/// Judges anew which observations agree with their points, over all tracks seen in `first_keyframe`
/// or later; points that keep fewer than two, or lose their parallax, are given up (the track may
/// win another later). Returns how many observations changed sides.
int judge_observations(const CameraModel& camera, const PointOptions& options, int first_keyframe,
                       Scene& scene);

}  // namespace handeye
