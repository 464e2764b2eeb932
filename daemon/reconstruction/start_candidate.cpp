// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/start_candidate.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/geometry/median.hpp"
#include "daemon/geometry/projection.hpp"
#include "daemon/reconstruction/bundle_adjustment.hpp"
#include "daemon/reconstruction/scene_points.hpp"
#include "daemon/reconstruction/triangulation.hpp"

namespace handeye {
namespace {

constexpr int kRounds = 2;
constexpr int kIterations = 20;
constexpr double kFunctionTolerance = 1e-5;

PointOptions point_options(const ReconstructionOptions& options) {
  return {options.max_reprojection_px, 0.5 * options.min_triangulation_deg};
}

void find_points(const CameraModel& camera, const ReconstructionOptions& options, Scene& scene) {
  triangulate_all(camera, point_options(options), scene);
  judge_observations(camera, point_options(options), 0, scene);
}

double parallax_of(const Scene& scene, const Track& track, std::vector<PosedRay>& rays) {
  rays.clear();
  for (const TrackObservation& seen : track.observations) {
    if (!seen.inlier) continue;
    rays.push_back(
        {&scene.keyframes[static_cast<std::size_t>(seen.keyframe)].eye_from_scene, seen.ray});
  }
  return triangulation_angle_rad(rays, track.point_scene);
}

/// What frames show whose pose is unknown is as wrong as can be: else the hypothesis that fits the
/// fewest frames had the smallest error.
void measure(const CameraModel& camera, double max_px, StartCandidate& candidate) {
  const Scene& scene = candidate.scene;
  int count = candidate.missing_observations;
  double sum = count * max_px * max_px;
  int inliers = 0;
  std::vector<double> parallaxes;
  std::vector<PosedRay> rays;
  for (const Track& track : scene.tracks) {
    if (track.observations.size() < 2) continue;
    if (track.has_point) parallaxes.push_back(parallax_of(scene, track, rays));
    for (const TrackObservation& seen : track.observations) {
      ++count;
      double error_px = max_px;
      if (track.has_point && seen.inlier) {
        const Pose& pose = scene.keyframes[static_cast<std::size_t>(seen.keyframe)].eye_from_scene;
        const Eigen::Vector3d point_eye = pose * track.point_scene;
        error_px = std::min(max_px, (project<double>(camera, point_eye) - seen.pixel).norm());
        ++inliers;
      }
      sum += error_px * error_px;
    }
  }
  candidate.error_px = std::sqrt(sum / std::max(1, count));
  candidate.inlier_ratio = static_cast<double>(inliers) / std::max(1, count);
  candidate.parallax_rad = median(std::move(parallaxes));
}

/// First keyframe to the origin, the farthest from it to distance 1.
void normalise(Scene& scene) {
  const Pose scene_from_first = scene.keyframes.front().eye_from_scene.inverse();
  double farthest = 0.0;
  for (Keyframe& keyframe : scene.keyframes) {
    keyframe.eye_from_scene = keyframe.eye_from_scene * scene_from_first;
    farthest = std::max(farthest, keyframe.eye_from_scene.inverse().translation().norm());
  }
  if (!(farthest > 0)) return;
  for (Keyframe& keyframe : scene.keyframes) keyframe.eye_from_scene.translation() /= farthest;
  for (Track& track : scene.tracks) track.has_point = false;
}

}  // namespace

StartCandidate make_candidate(const CameraModel& camera, const ReconstructionOptions& options,
                              const StartWindow& window, const StartHypothesis& hypothesis,
                              Eigen::Index most_tracks) {
  StartCandidate candidate;
  candidate.method = hypothesis.method;
  Scene& scene = candidate.scene;
  for (Eigen::Index f = 0; f < window.frame_count(); ++f) {
    const auto& pose = hypothesis.eye_from_scene[static_cast<std::size_t>(f)];
    const FrameRecord frame = window.thinned(f, most_tracks);
    if (pose) {
      scene.add_keyframe(camera, frame, *pose, 0.0);
    } else {
      candidate.missing_observations += static_cast<int>(frame.observations.size());
    }
  }
  normalise(scene);
  find_points(camera, options, scene);
  measure(camera, options.max_reprojection_px, candidate);
  return candidate;
}

void adjust_candidate(const CameraModel& camera, const ReconstructionOptions& options,
                      StartCandidate& candidate) {
  AdjustmentOptions adjustment;
  adjustment.robust_px = options.robust_px;
  adjustment.max_iterations = kIterations;
  adjustment.function_tolerance = kFunctionTolerance;
  adjustment.threads = options.threads;
  for (int round = 0; round < kRounds; ++round) {
    if (round > 0) find_points(camera, options, candidate.scene);
    adjust(camera, adjustment, candidate.scene);
    judge_observations(camera, point_options(options), 0, candidate.scene);
  }
  measure(camera, options.max_reprojection_px, candidate);
}

StartCandidate complete_candidate(const CameraModel& camera, const ReconstructionOptions& options,
                                  const StartWindow& window, const StartCandidate& candidate) {
  StartCandidate complete;
  complete.method = candidate.method;
  const auto& known = candidate.scene.keyframes;
  for (const FrameRecord* frame : window.frames) {
    const auto keyframe = std::ranges::find(known, frame->index, &Keyframe::frame_index);
    if (keyframe != known.end()) {
      complete.scene.add_keyframe(camera, *frame, keyframe->eye_from_scene, 0.0);
    } else {
      complete.missing_observations += static_cast<int>(frame->observations.size());
    }
  }
  normalise(complete.scene);
  find_points(camera, options, complete.scene);
  adjust_candidate(camera, options, complete);
  return complete;
}

}  // namespace handeye
