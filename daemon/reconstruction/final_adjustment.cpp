// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/final_adjustment.hpp"

#include <algorithm>

#include "daemon/reconstruction/bundle_adjustment.hpp"
#include "daemon/reconstruction/point_trust.hpp"
#include "daemon/reconstruction/scene_points.hpp"

namespace handeye {
namespace {

constexpr int kMostRounds = 3;
constexpr int kFewestIterations = 4;
constexpr int kMostIterations = 50;
/// Small scenes, whose frames lie far apart, need more steps and can afford them: iterations times
/// observations.
constexpr double kAffordable = 3e5;
constexpr double kTolerance = 1e-6;
/// Verdicts changed, as a share of all observations, above which another round follows.
constexpr double kManyChanged = 0.005;

std::size_t observation_count(const Scene& scene) {
  std::size_t count = 0;
  for (const Track& track : scene.tracks) {
    if (track.has_point) count += track.observations.size();
  }
  return count;
}

}  // namespace

void adjust_finally(const CameraModel& camera, const ReconstructionOptions& options, Scene& scene) {
  const PointOptions points{options.max_reprojection_px, options.min_triangulation_deg};
  AdjustmentOptions adjustment;
  adjustment.robust_px = options.robust_px;
  adjustment.threads = options.threads;
  adjustment.function_tolerance = kTolerance;
  for (int round = 0; round < kMostRounds; ++round) {
    triangulate_all(camera, points, scene);
    judge_observations(camera, points, 0, scene);
    drop_distrusted_points(scene);
    const auto observations = static_cast<double>(observation_count(scene));
    adjustment.max_iterations = static_cast<int>(std::clamp<double>(
        kAffordable / std::max(1.0, observations), kFewestIterations, kMostIterations));
    adjust(camera, adjustment, scene);
    const int changed = judge_observations(camera, points, 0, scene);
    if (changed < kManyChanged * observations) return;
  }
}

}  // namespace handeye
