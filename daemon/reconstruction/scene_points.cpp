// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/scene_points.hpp"

#include <algorithm>
#include <limits>

#include "daemon/reconstruction/triangulation.hpp"

namespace handeye {
namespace {

/// A point once won is given up only well below the angle that won it: no flicker at the threshold.
constexpr double kKeepAngleFraction = 0.6;

const Pose& pose_of(const Scene& scene, const TrackObservation& seen) {
  return scene.keyframes[static_cast<std::size_t>(seen.keyframe)].eye_from_scene;
}

double error_px(const CameraModel& camera, const Scene& scene, const TrackObservation& seen,
                const Eigen::Vector3d& point_scene) {
  const Eigen::Vector3d point_eye = pose_of(scene, seen) * point_scene;
  if (!(point_eye.z() > 1e-6)) return std::numeric_limits<double>::infinity();
  return (project<double>(camera, point_eye) - seen.pixel).norm();
}

void collect_inlier_rays(const Scene& scene, const Track& track, std::vector<PosedRay>& rays) {
  rays.clear();
  for (const TrackObservation& seen : track.observations) {
    if (seen.inlier) rays.push_back({&pose_of(scene, seen), seen.ray});
  }
}

/// Triangulates from the inliers, dropping the worst observation as long as one does not fit.
bool triangulate_track(const CameraModel& camera, const PointOptions& options, const Scene& scene,
                       Track& track, std::vector<PosedRay>& rays) {
  const std::size_t fewest = std::max<std::size_t>(2, (2 * track.observations.size() + 2) / 3);
  for (TrackObservation& seen : track.observations) seen.inlier = true;
  for (collect_inlier_rays(scene, track, rays); rays.size() >= fewest;
       collect_inlier_rays(scene, track, rays)) {
    const auto point = triangulate(rays);
    if (!point) return false;
    TrackObservation* worst = nullptr;
    double worst_px = options.max_reprojection_px;
    for (TrackObservation& seen : track.observations) {
      const double error = seen.inlier ? error_px(camera, scene, seen, *point) : 0.0;
      if (error > worst_px) {
        worst_px = error;
        worst = &seen;
      }
    }
    if (worst == nullptr) {
      if (triangulation_angle_rad(rays, *point) < rad_from_deg(options.min_triangulation_deg)) {
        return false;
      }
      track.point_scene = *point;
      track.has_point = true;
      return true;
    }
    worst->inlier = false;
  }
  return false;
}

bool may_win_point(const Track& track) {
  return !track.has_point && !track.refused && track.observations.size() >= 2;
}

}  // namespace

int triangulate_tracks(const CameraModel& camera, const PointOptions& options, int keyframe,
                       Scene& scene) {
  int won = 0;
  std::vector<PosedRay> rays;
  for (const int position : scene.keyframes[static_cast<std::size_t>(keyframe)].tracks) {
    Track& track = scene.tracks[static_cast<std::size_t>(position)];
    if (may_win_point(track) && triangulate_track(camera, options, scene, track, rays)) ++won;
  }
  return won;
}

int triangulate_all(const CameraModel& camera, const PointOptions& options, Scene& scene) {
  int won = 0;
  std::vector<PosedRay> rays;
  for (Track& track : scene.tracks) {
    if (may_win_point(track) && triangulate_track(camera, options, scene, track, rays)) ++won;
  }
  return won;
}

int judge_observations(const CameraModel& camera, const PointOptions& options, int first_keyframe,
                       Scene& scene) {
  int changed = 0;
  std::vector<PosedRay> rays;
  for (Track& track : scene.tracks) {
    if (!track.has_point || track.observations.empty()) continue;
    if (track.observations.back().keyframe < first_keyframe) continue;
    for (TrackObservation& seen : track.observations) {
      const bool inlier =
          error_px(camera, scene, seen, track.point_scene) <= options.max_reprojection_px;
      if (inlier != seen.inlier) ++changed;
      seen.inlier = inlier;
    }
    collect_inlier_rays(scene, track, rays);
    if (rays.size() < 2 || triangulation_angle_rad(rays, track.point_scene) <
                               kKeepAngleFraction * rad_from_deg(options.min_triangulation_deg)) {
      track.has_point = false;
    }
  }
  return changed;
}

}  // namespace handeye
