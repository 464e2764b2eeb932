// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/maximum_likelihood.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "daemon/handeye/methods/methods.hpp"
#include "daemon/handeye/pose_covariance.hpp"
#include "daemon/handeye/pose_problem.hpp"
#include "daemon/handeye/robust_solve.hpp"
#include "daemon/handeye/scale_profile.hpp"
#include "daemon/handeye/selection.hpp"
#include "daemon/handeye/starts.hpp"
#include "daemon/handeye/usable.hpp"

namespace handeye {
namespace {

constexpr double kDoubtedLogScale = 0.003;  // sigma from which on other scales are tried
constexpr double kUndecidedSigmas = 0.5;    // standard deviations that an undecided distance is

double square(double x) {
  return x * x;
}

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
  return observations.size() >= kFewestLikelihoodPoses &&
         std::all_of(observations.begin(), observations.end(), good);
}

double degrees_of_freedom(const PoseProblem& problem, std::size_t poses) {
  return std::max(1.0, 6.0 * static_cast<double>(poses) - problem.parameters());
}

/// Noise that was given is believed within what chance explains; beyond it, by how much is it
/// exceeded.
double excess(const std::vector<Vector6d>& residuals, const Matrix6d& whitening, double freedom,
              double huber) {
  double chi2 = 0;
  for (const Vector6d& residual : residuals) {
    const double norm = (whitening * residual).norm();
    chi2 += std::min(norm, huber) * norm;
  }
  const double chance = 1.0 + 3.3 * std::sqrt(2.0 / freedom);
  return chi2 / freedom > chance ? chi2 / freedom : 1.0;
}

MaximumLikelihoodResult describe(const PoseProblem& problem,
                                 const ResidualNoise::Variances& variances,
                                 const MaximumLikelihoodOptions& options) {
  const std::vector<Vector6d> residuals = problem.residuals();
  const ResidualNoise noise(problem.unknowns().eye_in_hand_mm);
  const Matrix6d whitening = noise.whitening(variances);
  const double freedom = degrees_of_freedom(problem, residuals.size());

  MaximumLikelihoodResult result;
  result.solution = problem.solution();
  result.room_from_scene = problem.room_from_scene();
  result.poses_used = residuals.size();
  for (std::size_t k = 0; k < problem.kept().size(); ++k) {
    if (!problem.kept()[k]) result.rejected.push_back(k);
  }
  result.noise = noise_of(variances);
  const Matrix6d assumed = noise.whitening(variances_of(options.noise));
  for (const Vector6d& residual : residuals) {
    result.chi2_per_dof += (assumed * residual).squaredNorm() / freedom;
  }

  if (options.account_for_correlation) {
    result.correlation_inflation = correlation_time(residuals, whitening);
  }
  const double inflation =
      result.correlation_inflation *
      (options.estimate_noise ? 1.0 : excess(residuals, whitening, freedom, options.huber));
  UnknownsMatrix covariance =
      inflation * covariance_of_unknowns(problem, variances, options.estimate_noise);
  if (options.estimate_scale && covariance(kLogScale, kLogScale) > square(kDoubtedLogScale)) {
    const double undecided = undecided_log_scale(problem, options, variances, inflation);
    widen_scale(covariance, kUndecidedSigmas * undecided);
  }
  result.covariance = covariance.topLeftCorner<6, 6>();
  result.sigma_translation_known_scale_mm = result.sigma_translation_mm();
  if (options.estimate_scale) {
    const double variance = covariance(kLogScale, kLogScale);
    result.log_scale_sigma = std::sqrt(variance);
    const double explained = covariance.block<3, 1>(kEyeShift, kLogScale).squaredNorm() / variance;
    result.sigma_translation_known_scale_mm =
        std::sqrt(std::max(0.0, covariance.block<3, 3>(kEyeShift, kEyeShift).trace() - explained));
  }
  if (options.estimate_time_offset) {
    result.time_offset_correction_s = problem.unknowns().time_offset_s;
    result.time_offset_sigma_s = std::sqrt(covariance(kTimeOffset, kTimeOffset));
  }
  return result;
}

std::optional<MaximumLikelihoodResult> refine(std::span<const HandEyeObservation> observations,
                                              const HandEyeSolution& start,
                                              const MaximumLikelihoodOptions& options) {
  if (!usable(options.noise)) return std::nullopt;
  PoseProblem problem(observations, start, options);
  const ResidualNoise::Variances variances = solve_without_outliers(problem, options);
  MaximumLikelihoodResult result = describe(problem, variances, options);
  if (!is_usable(result.solution) || !result.covariance.allFinite()) return std::nullopt;
  return result;
}

std::optional<MaximumLikelihoodResult> from_movements(
    std::span<const HandEyeObservation> observations, std::span<const Movement> movements,
    const MaximumLikelihoodOptions& options) {
  const ScaleMode scale = options.estimate_scale ? ScaleMode::kUnknown : ScaleMode::kKnown;
  const auto start = best_start(observations, starting_solutions(movements, scale), options);
  if (!start) return std::nullopt;
  return refine(observations, *start, options);
}

/// As a method of the table.
std::optional<HandEyeSolution> solve_as_method(const HandEyeProblem& problem, ScaleMode scale) {
  std::vector<HandEyeObservation> observations;
  observations.reserve(problem.poses.size());
  for (const PosePair& pair : problem.poses) observations.push_back({.poses = pair});
  if (!usable(observations)) return std::nullopt;
  const auto result = from_movements(observations, problem.movements,
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
  std::vector<PosePair> poses;
  poses.reserve(observations.size());
  for (const HandEyeObservation& observation : observations) poses.push_back(observation.poses);
  const ScaleMode scale = options.estimate_scale ? ScaleMode::kUnknown : ScaleMode::kKnown;
  return from_movements(observations, select_movements(poses, {.scale = scale}).movements, options);
}

std::optional<HandEyeSolution> maximum_likelihood_unknown_scale(const HandEyeProblem& problem) {
  return solve_as_method(problem, ScaleMode::kUnknown);
}

std::optional<HandEyeSolution> maximum_likelihood_known_scale(const HandEyeProblem& problem) {
  return solve_as_method(problem, ScaleMode::kKnown);
}

}  // namespace handeye
