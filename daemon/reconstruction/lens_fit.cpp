// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/reconstruction/lens_fit.hpp"

#include <algorithm>
#include <numbers>

#include "daemon/reconstruction/scene_points.hpp"

namespace handeye {
namespace {

/// Under a lens that is not right yet, what is right is off by more than it will be.
constexpr double kWideGate = 2.0;
/// Features are not better than this, nor, in a lens that is nearly right, worse than that.
constexpr double kLeastNoisePx = 0.1;
constexpr double kMostNoisePx = 0.5;
constexpr int kPolishRounds = 4;
constexpr int kSettled = 5;  ///< observations that may still change sides

PointOptions point_options(const ReconstructionOptions& options, double gate) {
  return {gate * options.max_reprojection_px, options.min_triangulation_deg};
}

/// Wins points anew and judges observations; returns how many changed.
int sort_out(const CameraModel& camera, const PointOptions& points, Scene& scene) {
  const int won = triangulate_all(camera, points, scene);
  return won + judge_observations(camera, points, 0, scene);
}

AdjustmentOptions adjustment_options(const ReconstructionOptions& options, bool last) {
  return {.robust_px = options.robust_px,
          .max_iterations = last ? 50 : 15,
          .function_tolerance = last ? 1e-9 : 1e-5,
          .threads = options.threads};
}

}  // namespace

std::array<bool, kLensParameters> free_lens(std::span<const LensParameter> parameters) {
  std::array<bool, kLensParameters> free{};
  for (const LensParameter parameter : parameters) free[parameter] = true;
  return free;
}

std::array<bool, kLensParameters> whole_lens() {
  std::array<bool, kLensParameters> free{};
  free.fill(true);
  return free;
}

void fit_lens(const LensPrior& prior, bool last_stage, const ReconstructionOptions& options,
              Scene& scene, CameraModel& camera) {
  const std::array stages{free_lens(std::array{kFocal}), free_lens(std::array{kFocal, kK1}),
                          whole_lens()};
  const std::size_t count = last_stage ? stages.size() : stages.size() - 1;
  for (std::size_t i = 0; i < count; ++i) {
    sort_out(camera, point_options(options, kWideGate), scene);
    adjust({stages[i], prior}, adjustment_options(options, false), scene, camera);
  }
  sort_out(camera, point_options(options, 1.0), scene);
  adjust({stages[count - 1], prior}, adjustment_options(options, false), scene, camera);
  sort_out(camera, point_options(options, 1.0), scene);
}

void polish_lens(const LensPrior& prior, const ReconstructionOptions& options, Scene& scene,
                 CameraModel& camera) {
  LensFreedom freedom{whole_lens(), prior};
  for (int round = 0; round < kPolishRounds; ++round) {
    const int changed = sort_out(camera, point_options(options, 1.0), scene);
    const bool last = round > 0 && (changed < kSettled || round + 1 == kPolishRounds);
    const double error_px = adjust(freedom, adjustment_options(options, last), scene, camera);
    // The prior counts for as much as it would beside features as good as these.
    freedom.noise_px = std::clamp(error_px / std::numbers::sqrt2, kLeastNoisePx, kMostNoisePx);
    if (last) break;
  }
  sort_out(camera, point_options(options, 1.0), scene);
}

}  // namespace handeye
