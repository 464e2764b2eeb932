// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/reconstruction/scene.hpp"

namespace handeye {

/// Trust in points, from their history: a point that agreed with many frames outweighs new ones, so
/// that what moves on its own (an instrument, whose features agree with each other) never becomes
/// what the camera's pose is told by.

/// Whether a point has proved itself: by frames, or by three keyframes where frames are few.
bool is_trusted(const Track& track);

/// What a point counts for in a resection, in (0, 1].
double trust_weight(const Track& track);

/// The frame's verdict on its matches (`Scene::find_matches` of this scene): each that lies within
/// `max_px` gains trust, each other loses it. Points that lost all of it are refused for good.
void update_trust(const CameraModel& camera, const Pose& eye_from_scene,
                  const std::vector<PointMatch>& matches, double max_px, Scene& scene);

/// Takes the points away that more has spoken against than for; their tracks may win them again.
void drop_distrusted_points(Scene& scene);

}  // namespace handeye
