// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/reconstruction/appearances.hpp"
#include "daemon/reconstruction/frame_record.hpp"
#include "daemon/reconstruction/resection.hpp"
#include "daemon/reconstruction/scene.hpp"

namespace handeye {

/// A feature recognised as one whose track was lost.
struct Recognition {
  std::int64_t feature_id{0};
  int track{-1};  ///< position in Scene::tracks
};

/// Features of a frame that look like a point of the scene which no other feature of the frame
/// shows, and lie within `radius_px` of where the pose puts it. Features that already have a point
/// keep it.
std::vector<Recognition> recognise_near(const CameraModel& camera, const Pose& eye_from_scene,
                                        const FrameRecord& frame, const Appearances& appearances,
                                        double radius_px, const Scene& scene);

/// A frame found again in a scene.
struct Relocalisation {
  Pose eye_from_scene{Pose::Identity()};
  std::vector<Recognition> recognised;
};

/// Finds a frame in a scene none of whose features it shares, by what they look like: the nearest
/// description of all, clearly nearer than the second, P3P in RANSAC, and a second look near where
/// that pose puts the points. Nothing where the scene is not what the frame shows, or what was
/// recognised lies too loosely for a part to go on from. Deterministic.
std::optional<Relocalisation> relocalise(const CameraModel& camera, const FrameRecord& frame,
                                         const Appearances& appearances,
                                         const ResectionOptions& options, const Scene& scene);

}  // namespace handeye
