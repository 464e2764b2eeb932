// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/scene_start.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/reconstruction/bundle_adjustment.hpp"
#include "daemon/reconstruction/projection.hpp"
#include "daemon/reconstruction/resection.hpp"
#include "daemon/reconstruction/scene_points.hpp"
#include "daemon/reconstruction/two_view.hpp"

namespace handeye {
namespace {

/// Median movement [px at kReferenceFocalPx] below which the picture stands still: twice what
/// half a pixel of noise in both views looks like.
constexpr double kStillPx = 2.0;
/// A rotation that explains this share of the features explains the movement.
constexpr double kRotationRatio = 0.8;
/// Share of the features that must obey the motion between the two views.
constexpr double kMinMotionRatio = 0.4;
/// Two views fit many a motion; those between them are what refutes a wrong one.
constexpr std::size_t kFewestFrames = 4;
constexpr int kMaxMotions = 5;
constexpr int kFramesBetween = 4;
/// Share of the observations that the adjusted scene must explain.
constexpr double kMinInlierRatio = 0.5;
/// The winner's error must be smaller by this factor than any other motion's.
constexpr double kClearMargin = 1.2;
constexpr double kSameRotationRad = 0.02;

struct Candidate {
  Scene scene;
  double error_px{0};  ///< rms over all observations, each capped at the outlier threshold
  double inlier_ratio{0};
};

std::vector<RayPair> to_rays(const CameraModel& camera, const std::vector<PixelPair>& pairs) {
  std::vector<RayPair> rays;
  for (const PixelPair& pair : pairs) {
    const auto first = unproject(camera, pair.first);
    const auto second = unproject(camera, pair.second);
    if (first && second) rays.push_back({*first, *second});
  }
  return rays;
}

PointOptions point_options(const ReconstructionOptions& options) {
  return {options.max_reprojection_px, 0.5 * options.min_triangulation_deg};
}

void triangulate_all(const CameraModel& camera, const ReconstructionOptions& options,
                     Scene& scene) {
  for (int k = 1; k < static_cast<int>(scene.keyframes.size()); ++k) {
    triangulate_tracks(camera, point_options(options), k, scene);
  }
}

/// The two views, and frames between them resected against the points of the two.
Scene scene_from_motion(const CameraModel& camera, const ReconstructionOptions& options,
                        std::span<const FrameRecord> frames, const Pose& last_from_first) {
  Scene pair;
  pair.add_keyframe(camera, frames.front(), Pose::Identity(), 0.0);
  pair.add_keyframe(camera, frames.back(), last_from_first, 0.0);
  triangulate_all(camera, options, pair);

  Scene scene;
  scene.add_keyframe(camera, frames.front(), Pose::Identity(), 0.0);
  const ResectionOptions resection{options.max_reprojection_px, options.robust_px,
                                   options.min_resection_inliers, options.min_resection_ratio};
  std::vector<PointMatch> matches;
  const std::size_t last = frames.size() - 1;
  for (std::size_t step = 1; step <= kFramesBetween; ++step) {
    const std::size_t between = step * last / (kFramesBetween + 1);
    if (between == 0 || frames[between].index == scene.keyframes.back().frame_index) continue;
    pair.find_matches(frames[between], matches);
    const double fraction = static_cast<double>(between) / static_cast<double>(last);
    const auto resected = resect(
        camera, matches, interpolate(Pose::Identity(), last_from_first, fraction), resection);
    if (resected) scene.add_keyframe(camera, frames[between], resected->eye_from_scene, 0.0);
  }
  scene.add_keyframe(camera, frames.back(), last_from_first, 0.0);
  return scene;
}

void measure(const CameraModel& camera, double max_px, Candidate& candidate) {
  double sum = 0.0;
  int count = 0;
  int inliers = 0;
  for (const Track& track : candidate.scene.tracks) {
    if (track.observations.size() < 2) continue;
    for (const TrackObservation& seen : track.observations) {
      ++count;
      double error_px = max_px;
      if (track.has_point && seen.inlier) {
        const Pose& pose =
            candidate.scene.keyframes[static_cast<std::size_t>(seen.keyframe)].eye_from_scene;
        const Eigen::Vector3d point_eye = pose * track.point_scene;
        error_px = std::min(max_px, (project<double>(camera, point_eye) - seen.pixel).norm());
        ++inliers;
      }
      sum += error_px * error_px;
    }
  }
  candidate.error_px = std::sqrt(sum / std::max(1, count));
  candidate.inlier_ratio = static_cast<double>(inliers) / std::max(1, count);
}

Candidate build_candidate(const CameraModel& camera, const ReconstructionOptions& options,
                          std::span<const FrameRecord> frames, const Pose& last_from_first) {
  Candidate candidate;
  Scene& scene = candidate.scene;
  scene = scene_from_motion(camera, options, frames, last_from_first);
  AdjustmentOptions adjustment;
  adjustment.robust_px = options.robust_px;
  adjustment.max_iterations = 20;
  adjustment.function_tolerance = 1e-5;
  adjustment.threads = options.threads;
  for (int round = 0; round < 2; ++round) {
    triangulate_all(camera, options, scene);
    judge_observations(camera, point_options(options), 0, scene);
    adjust(camera, adjustment, scene);
    judge_observations(camera, point_options(options), 0, scene);
  }
  measure(camera, options.max_reprojection_px, candidate);
  return candidate;
}

/// The motion from the first to the last view.
Pose whole_motion(const Scene& scene) {
  return scene.keyframes.back().eye_from_scene * scene.keyframes.front().eye_from_scene.inverse();
}

bool clearly_best(const std::vector<Candidate>& sorted) {
  const Eigen::Matrix3d best = whole_motion(sorted.front().scene).linear();
  return std::none_of(sorted.begin() + 1, sorted.end(), [&](const Candidate& other) {
    const bool differs =
        rotation_angle_rad(best, whole_motion(other.scene).linear()) > kSameRotationRad;
    return differs && other.error_px < kClearMargin * sorted.front().error_px;
  });
}

}  // namespace

StartAttempt start_scene(const CameraModel& camera, const ReconstructionOptions& options,
                         std::span<const FrameRecord> frames) {
  StartAttempt attempt;
  const auto pairs = common_features(frames.front(), frames.back());
  if (static_cast<int>(pairs.size()) < options.min_common_features ||
      frames.size() < kFewestFrames) {
    return attempt;
  }
  if (median_movement_px(camera, pairs) < kStillPx) {
    attempt.state = ReconstructionState::kNoMotion;
    return attempt;
  }
  const auto rays = to_rays(camera, pairs);
  const double threshold_rad = 0.5 * options.max_reprojection_px / focal_px(camera);
  if (fit_rotation(rays, 2.0 * threshold_rad).inlier_ratio > kRotationRatio) {
    attempt.state = ReconstructionState::kNoParallax;
    return attempt;
  }
  attempt.costly = true;
  auto motions = two_view_motions(rays, threshold_rad);
  std::erase_if(motions, [](const auto& motion) { return motion.inlier_ratio < kMinMotionRatio; });
  if (motions.empty()) return attempt;

  attempt.state = ReconstructionState::kNoParallax;
  const double min_parallax_rad = options.min_start_parallax_px / kReferenceFocalPx;
  std::erase_if(motions,
                [&](const auto& motion) { return motion.parallax_rad < min_parallax_rad; });
  if (motions.empty()) return attempt;
  if (motions.size() > kMaxMotions) motions.resize(kMaxMotions);

  std::vector<Candidate> candidates;
  candidates.reserve(motions.size());
  for (const TwoViewMotion& motion : motions) {
    candidates.push_back(build_candidate(camera, options, frames, motion.second_from_first));
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.error_px < b.error_px; });
  Candidate& best = candidates.front();
  if (best.inlier_ratio < kMinInlierRatio ||
      best.scene.point_count() < options.min_common_features || !clearly_best(candidates)) {
    return attempt;
  }
  attempt.state = ReconstructionState::kTracking;
  attempt.scene = std::move(best.scene);
  return attempt;
}

}  // namespace handeye
