// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/start_factorisation.hpp"

#include "daemon/reconstruction/perspective_alternation.hpp"
#include "daemon/reconstruction/start_consensus.hpp"

namespace handeye {
namespace {

/// Each frame brings six unknowns, and three of them are the fewest that fix a metric.
constexpr Eigen::Index kFewestFrames = 4;
constexpr std::size_t kFewestTracks = 20;
/// Perspective terms that change by less than this are settled: adjustment follows.
constexpr double kSettled = 1e-4;

Eigen::MatrixXd rays_of(const StartWindow& window, const std::vector<Eigen::Index>& columns) {
  Eigen::MatrixXd rays(window.rays.rows(), static_cast<Eigen::Index>(columns.size()));
  for (Eigen::Index i = 0; i < rays.cols(); ++i) {
    rays.col(i) = window.rays.col(columns[static_cast<std::size_t>(i)]);
  }
  return rays;
}

}  // namespace

std::vector<StartHypothesis> start_by_factorisation(const StartWindow& window, double noise) {
  std::vector<StartHypothesis> hypotheses;
  if (window.frame_count() < kFewestFrames) return hypotheses;
  const auto columns = consistent_tracks(window.rays, noise);
  if (columns.size() < kFewestTracks) return hypotheses;
  const Eigen::MatrixXd rays = rays_of(window, columns);
  for (const Reversal reversal : {Reversal::kFirst, Reversal::kMirrored}) {
    const auto solution = solve_perspective(rays, reversal, {.settled = kSettled});
    if (solution.eye_from_scene.empty()) continue;
    StartHypothesis hypothesis{StartMethod::kFactorisation, {}};
    const Pose scene_from_first = solution.eye_from_scene.front().inverse();
    for (const Pose& pose : solution.eye_from_scene) {
      hypothesis.eye_from_scene.emplace_back(pose * scene_from_first);
    }
    hypotheses.push_back(std::move(hypothesis));
  }
  return hypotheses;
}

}  // namespace handeye
