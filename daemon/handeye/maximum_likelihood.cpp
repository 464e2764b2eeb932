// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/maximum_likelihood.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "daemon/handeye/likelihood_result.hpp"
#include "daemon/handeye/methods/methods.hpp"
#include "daemon/handeye/movements_within_parts.hpp"
#include "daemon/handeye/part_agreement.hpp"
#include "daemon/handeye/parts.hpp"
#include "daemon/handeye/pose_problem.hpp"
#include "daemon/handeye/robust_solve.hpp"
#include "daemon/handeye/scene_placement.hpp"
#include "daemon/handeye/starts.hpp"
#include "daemon/handeye/usable.hpp"

namespace handeye {
namespace {

bool usable(const PoseNoise& noise) {
  const auto good = [](double sigma) { return std::isnormal(sigma) && sigma > 0; };
  return good(noise.hand_rotation_rad) && good(noise.hand_translation_mm) &&
         good(noise.eye_rotation_rad) && good(noise.eye_translation_mm);
}

bool usable(std::span<const HandEyeObservation> observations) {
  const auto good = [](const HandEyeObservation& o) {
    return is_usable(o.poses.room_from_hand) && is_usable(o.poses.eye_from_scene) &&
           o.hand_angular_velocity.allFinite() && o.hand_velocity.allFinite();
  };
  return !observations.empty() && std::all_of(observations.begin(), observations.end(), good) &&
         parts_of(observations).front().members.size() >= kFewestLikelihoodPoses;
}

std::optional<MaximumLikelihoodResult> refine(std::span<const HandEyeObservation> observations,
                                              const HandEyeSolution& start,
                                              const MaximumLikelihoodOptions& options) {
  if (!usable(options.noise)) return std::nullopt;
  PoseProblem problem(observations, start, options);
  PartNoise noise = solve_without_outliers(problem, options);
  const PartAgreement agreement = leave_out_contradicting_parts(problem, noise, options);
  MaximumLikelihoodResult result = describe(problem, noise, agreement, options);
  if (!is_usable(result.solution) || !result.covariance.allFinite()) return std::nullopt;
  return result;
}

/// A start's scale is the largest part's: where its movements are of other parts only, by the path
/// that the camera went in the largest, as they say.
void to_largest_part(std::span<const HandEyeObservation> observations,
                     std::vector<HandEyeSolution>& starts) {
  const std::vector<PosePair> largest = poses_of(observations, parts_of(observations).front());
  for (HandEyeSolution& start : starts) start.scale_units_per_mm = scale_of_path(largest, start);
}

std::optional<MaximumLikelihoodResult> from_movements(
    std::span<const HandEyeObservation> observations, const MovementsOfParts& within,
    const MaximumLikelihoodOptions& options) {
  const ScaleMode scale = options.estimate_scale ? ScaleMode::kUnknown : ScaleMode::kKnown;
  std::vector<HandEyeSolution> starts = starting_solutions(within.movements, scale);
  if (options.estimate_scale && within.unit_part > 0) to_largest_part(observations, starts);
  const auto start = best_start(observations, starts, options);
  if (!start) return std::nullopt;
  return refine(observations, *start, options);
}

/// As a method of the table.
std::optional<HandEyeSolution> solve_as_method(const HandEyeProblem& problem, ScaleMode scale) {
  std::vector<HandEyeObservation> observations;
  observations.reserve(problem.poses.size());
  for (const PosePair& pair : problem.poses) observations.push_back({.poses = pair});
  if (!usable(observations)) return std::nullopt;
  const auto result = from_movements(
      observations, {.movements = {problem.movements.begin(), problem.movements.end()}},
      {.noise = problem.noise,
       .estimate_noise = problem.estimate_noise,
       .estimate_scale = scale == ScaleMode::kUnknown});
  if (!result) return std::nullopt;
  return result->solution;
}

}  // namespace

double sigma_rotation_deg(const Matrix6d& covariance) {
  return deg_from_rad(std::sqrt(covariance.topLeftCorner<3, 3>().trace()));
}

double sigma_translation_mm(const Matrix6d& covariance) {
  return std::sqrt(covariance.bottomRightCorner<3, 3>().trace());
}

double MaximumLikelihoodResult::sigma_rotation_deg() const {
  return handeye::sigma_rotation_deg(covariance);
}

double MaximumLikelihoodResult::sigma_translation_mm() const {
  return handeye::sigma_translation_mm(covariance);
}

std::optional<MaximumLikelihoodResult> maximum_likelihood(
    std::span<const HandEyeObservation> observations, const HandEyeSolution& start,
    const MaximumLikelihoodOptions& options) {
  if (!usable(observations) || !is_usable(start)) return std::nullopt;
  return refine(observations, start, options);
}

std::optional<MaximumLikelihoodResult> maximum_likelihood(
    std::span<const HandEyeObservation> observations, const MaximumLikelihoodOptions& options) {
  if (!usable(observations)) return std::nullopt;
  const ScaleMode scale = options.estimate_scale ? ScaleMode::kUnknown : ScaleMode::kKnown;
  return from_movements(observations, movements_within_parts(observations, scale), options);
}

std::optional<HandEyeSolution> maximum_likelihood_unknown_scale(const HandEyeProblem& problem) {
  return solve_as_method(problem, ScaleMode::kUnknown);
}

std::optional<HandEyeSolution> maximum_likelihood_known_scale(const HandEyeProblem& problem) {
  return solve_as_method(problem, ScaleMode::kKnown);
}

}  // namespace handeye
