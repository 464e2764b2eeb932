// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/lens_scene.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "daemon/reconstruction/frame_record.hpp"
#include "daemon/reconstruction/scene_points.hpp"

namespace handeye {
namespace {

std::vector<const RegisteredFrame*> chosen_keyframes(const Reconstruction& reconstruction,
                                                     int max_keyframes) {
  std::vector<const RegisteredFrame*> all;
  for (const RegisteredFrame& frame : reconstruction.frames) {
    if (frame.keyframe && frame.part == 0) all.push_back(&frame);
  }
  const auto at_most = static_cast<std::size_t>(max_keyframes);
  if (all.size() <= at_most) return all;
  std::vector<const RegisteredFrame*> chosen;
  for (std::size_t i = 0; i < at_most; ++i) chosen.push_back(all[i * all.size() / at_most]);
  return chosen;
}

}  // namespace

Scene scene_of(const CameraModel& camera, const Reconstruction& reconstruction,
               std::span<const TrackedFrame> frames, int max_keyframes,
               const ReconstructionOptions& options) {
  Scene scene;
  for (const RegisteredFrame* keyframe : chosen_keyframes(reconstruction, max_keyframes)) {
    const auto frame = std::ranges::lower_bound(frames, keyframe->index, {}, &TrackedFrame::index);
    if (frame == frames.end() || frame->index != keyframe->index) continue;
    scene.add_keyframe(camera, make_record(*frame), keyframe->eye_from_scene, 0.0);
  }
  const PointOptions points{options.max_reprojection_px, options.min_triangulation_deg};
  triangulate_all(camera, points, scene);
  judge_observations(camera, points, 0, scene);
  return scene;
}

SceneFit scene_fit(const CameraModel& camera, double max_reprojection_px, const Scene& scene) {
  double squares_px2 = 0.0;
  int seen_often = 0;
  int inliers = 0;
  for (const Track& track : scene.tracks) {
    if (track.observations.size() < 2) continue;
    for (const TrackObservation& seen : track.observations) {
      ++seen_often;
      double error_px = max_reprojection_px;
      const Pose& pose = scene.keyframes[static_cast<std::size_t>(seen.keyframe)].eye_from_scene;
      const Eigen::Vector3d point_eye = pose * track.point_scene;
      if (track.has_point && seen.inlier && point_eye.z() > 0) {
        error_px = std::min(error_px, (project<double>(camera, point_eye) - seen.pixel).norm());
        ++inliers;
      }
      squares_px2 += error_px * error_px;
    }
  }
  const double count = std::max(1, seen_often);
  return {std::sqrt(squares_px2 / count), inliers / count};
}

double distortion_sigma_px(const CameraModel& camera, const LensMatrix& covariance,
                           const Scene& scene) {
  double largest_px = 0.0;
  for (const Track& track : scene.tracks) {
    if (!track.has_point) continue;
    for (const TrackObservation& seen : track.observations) {
      if (!seen.inlier) continue;
      largest_px = std::max(largest_px, distortion_sigma_px(camera, covariance, seen.ray));
    }
  }
  return largest_px;
}

}  // namespace handeye
