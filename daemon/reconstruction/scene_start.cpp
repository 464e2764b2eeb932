// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/scene_start.hpp"

#include <algorithm>

#include "daemon/geometry/projection.hpp"
#include "daemon/reconstruction/start_candidate.hpp"
#include "daemon/reconstruction/start_choice.hpp"
#include "daemon/reconstruction/start_factorisation.hpp"
#include "daemon/reconstruction/start_rest.hpp"
#include "daemon/reconstruction/start_two_views.hpp"
#include "daemon/reconstruction/start_window.hpp"

namespace handeye {
namespace {

constexpr int kWindowFrames = 8;
/// In the window and in the scene: two views fit many a motion; those between them are what refutes
/// a wrong one.
constexpr int kFewestFrames = 4;
/// Median movement [px at kReferenceFocalPx] below which the picture stands still: twice what
/// half a pixel of noise in both views looks like.
constexpr double kStillPx = 2.0;
/// A rotation that explains this share of the features explains the movement.
constexpr double kRotationRatio = 0.6;
/// Share of the features that must obey the motion between the two views.
constexpr double kMinMotionRatio = 0.4;
/// Motions carried on from two views: four from the essential matrix, as many from a homography.
constexpr std::size_t kMostMotions = 5;
/// Hypotheses adjusted, the most promising first, and the tracks on which they compete.
constexpr std::size_t kMostCandidates = 4;
constexpr Eigen::Index kMostTracks = 80;
/// Share of the observations that the adjusted scene must explain.
constexpr double kMinInlierRatio = 0.5;

/// The frame that differs most from the first by more than a rotation.
struct WidestView {
  Eigen::Index frame{0};
  double movement_px{0};     ///< largest median movement against the first, at kReferenceFocalPx
  double rotation_ratio{1};  ///< of the features, explained by rotation alone
  double residual_rad{-1};
};

WidestView find_widest(const StartWindow& window, double threshold_rad) {
  WidestView widest;
  for (Eigen::Index f = 1; f < window.frame_count(); ++f) {
    const auto pairs = window.pairs_with_first(f);
    widest.movement_px = std::max(widest.movement_px, median_movement(pairs) * kReferenceFocalPx);
    const RotationFit rotation = fit_rotation(pairs, threshold_rad);
    if (rotation.residual_rad <= widest.residual_rad) continue;
    widest.frame = f;
    widest.rotation_ratio = rotation.inlier_ratio;
    widest.residual_rad = rotation.residual_rad;
  }
  return widest;
}

/// The hypotheses' scenes, best first, adjusted.
std::vector<StartCandidate> build_candidates(const CameraModel& camera,
                                             const ReconstructionOptions& options,
                                             const StartWindow& window,
                                             const std::vector<StartHypothesis>& hypotheses) {
  std::vector<StartCandidate> candidates;
  for (const StartHypothesis& hypothesis : hypotheses) {
    candidates.push_back(make_candidate(camera, options, window, hypothesis, kMostTracks));
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.error_px < b.error_px; });
  if (candidates.size() > kMostCandidates) candidates.resize(kMostCandidates);
  for (StartCandidate& candidate : candidates) adjust_candidate(camera, options, candidate);
  return candidates;
}

/// Whether enough of the frames and of what they show speak for a candidate, and nothing against.
bool acceptable(const StartCandidate& candidate, double min_parallax_rad, double threshold_rad) {
  return std::ssize(candidate.scene.keyframes) >= kFewestFrames &&
         candidate.inlier_ratio >= kMinInlierRatio && candidate.parallax_rad >= min_parallax_rad &&
         !contradicted(candidate.scene, threshold_rad);
}

}  // namespace

StartAttempt start_scene(const CameraModel& camera, const ReconstructionOptions& options,
                         std::span<const FrameRecord> frames) {
  StartAttempt attempt;
  const StartWindow window = make_start_window(camera, frames, kWindowFrames);
  if (window.feature_count() < options.min_common_features ||
      window.frame_count() < kFewestFrames) {
    return attempt;
  }
  const double threshold_rad = 0.5 * options.max_reprojection_px / focal_px(camera);
  const WidestView widest = find_widest(window, 2.0 * threshold_rad);
  if (widest.movement_px < kStillPx) {
    attempt.state = ReconstructionState::kNoMotion;
    return attempt;
  }
  if (widest.rotation_ratio > kRotationRatio) {
    attempt.state = ReconstructionState::kNoParallax;
    return attempt;
  }

  attempt.costly = true;
  const double min_parallax_rad = options.min_start_parallax_px / kReferenceFocalPx;
  auto motions = two_view_motions(window.pairs_with_first(widest.frame), threshold_rad);
  std::erase_if(motions, [](const auto& motion) { return motion.inlier_ratio < kMinMotionRatio; });
  const bool rigid = !motions.empty();
  if (rigid) attempt.state = ReconstructionState::kNoParallax;
  std::erase_if(motions,
                [&](const auto& motion) { return motion.parallax_rad < min_parallax_rad; });
  if (rigid && motions.empty()) return attempt;
  if (motions.size() > kMostMotions) motions.resize(kMostMotions);

  auto hypotheses = start_by_factorisation(window, threshold_rad);
  for (auto& hypothesis : start_by_two_views(camera, options, window, widest.frame, motions)) {
    hypotheses.push_back(std::move(hypothesis));
  }
  const auto candidates = build_candidates(camera, options, window, hypotheses);
  const auto chosen = choose_start(candidates);
  if (!chosen || !acceptable(candidates[*chosen], min_parallax_rad, 2.0 * threshold_rad)) {
    return attempt;
  }
  StartCandidate complete = complete_candidate(camera, options, window, candidates[*chosen]);
  if (complete.scene.point_count() < options.min_common_features ||
      contradicted(complete.scene, 2.0 * threshold_rad)) {
    return attempt;
  }
  attempt.state = ReconstructionState::kTracking;
  attempt.method = complete.method;
  attempt.scene = std::move(complete.scene);
  return attempt;
}

}  // namespace handeye
