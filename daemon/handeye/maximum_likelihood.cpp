// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/maximum_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include "daemon/handeye/methods/methods.hpp"
#include "daemon/handeye/noise_fit.hpp"
#include "daemon/handeye/pose_covariance.hpp"
#include "daemon/handeye/pose_problem.hpp"
#include "daemon/handeye/scale_profile.hpp"
#include "daemon/handeye/selection.hpp"
#include "daemon/handeye/starts.hpp"
#include "daemon/handeye/usable.hpp"

namespace handeye {
namespace {

constexpr std::size_t kMinPoses = 3;        // two movements
constexpr double kFarFromMedian = 5.0;      // of the norms at the start
constexpr int kRejections = 3;              // each with what the one before has left
constexpr double kDoubtedLogScale = 0.003;  // sigma from which on other scales are tried
constexpr double kUndecidedSigmas = 0.5;    // standard deviations that an undecided distance is
constexpr double kScaleSettled = 1e-4;      // change of the log scale that moves no weight
constexpr double kNoiseSettled = 0.01;      // relative change of a variance that moves no answer

double square(double x) {
  return x * x;
}

bool usable(std::span<const HandEyeObservation> observations) {
  const auto good = [](const HandEyeObservation& o) {
    return is_usable(o.poses.room_from_hand) && is_usable(o.poses.eye_from_scene) &&
           o.hand_angular_velocity.allFinite() && o.hand_velocity.allFinite();
  };
  return observations.size() >= kMinPoses &&
         std::all_of(observations.begin(), observations.end(), good);
}

bool usable(const HandEyeSolution& start) {
  return is_usable(start.hand_from_eye) && std::isnormal(start.scale_units_per_mm) &&
         start.scale_units_per_mm > 0;
}

ResidualNoise noise_at(const PoseProblem& problem) {
  return ResidualNoise(problem.unknowns().eye_in_hand_mm);
}

bool settled(const ResidualNoise::Variances& now, const ResidualNoise::Variances& before) {
  const auto near = [](double x, double y) { return std::abs(x - y) <= kNoiseSettled * y; };
  return near(now.hand_rotation, before.hand_rotation) &&
         near(now.eye_rotation, before.eye_rotation) && near(now.translation, before.translation);
}

/// Unknowns and noise in turn; the noise that was last fitted.
ResidualNoise::Variances solve(PoseProblem& problem, const MaximumLikelihoodOptions& options) {
  const ResidualNoise::Variances assumed = variances_of(options.noise);
  ResidualNoise::Variances variances = assumed;
  problem.minimise(variances);
  for (int round = 1; round < options.rounds; ++round) {
    const ResidualNoise::Variances before = variances;
    const double log_scale = problem.unknowns().log_scale;
    if (options.estimate_noise) {
      variances = fit_noise(problem.residuals(), noise_at(problem), problem.parameters(),
                            options.huber, assumed, before);
    }
    problem.minimise(variances);
    if (settled(variances, before) &&
        std::abs(problem.unknowns().log_scale - log_scale) < kScaleSettled) {
      break;
    }
  }
  return variances;
}

std::vector<bool> within(const std::vector<double>& norms, double limit) {
  std::vector<bool> result;
  result.reserve(norms.size());
  for (const double norm : norms) result.push_back(norm <= limit);
  return result;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Leaves out what already the start says is far from all others: one pose that is metres off turns
/// the whole scene, whatever the loss.
void leave_out_far_ones(PoseProblem& problem, const MaximumLikelihoodOptions& options) {
  if (!(options.reject > 0)) return;
  const std::vector<double> norms = problem.norms(variances_of(options.noise));
  problem.keep(within(norms, kFarFromMedian * std::max(median(norms), 1.0)));
}

/// Huber's loss bounds an outlier's pull but keeps it; many that pull the same way would still bias
/// the answer. So what the noise cannot explain is left out, and the rest solved again.
ResidualNoise::Variances solve_without_outliers(PoseProblem& problem,
                                                const MaximumLikelihoodOptions& options) {
  leave_out_far_ones(problem, options);
  ResidualNoise::Variances variances = solve(problem, options);
  for (int pass = 0; options.reject > 0 && pass < kRejections; ++pass) {
    const std::vector<double> norms = problem.norms(variances);
    std::vector<bool> kept = within(norms, options.reject);
    const auto left = static_cast<std::size_t>(std::count(kept.begin(), kept.end(), true));
    if (left < kMinPoses || 2 * left < kept.size()) kept.assign(norms.size(), true);
    if (kept == problem.kept()) break;
    problem.keep(std::move(kept));
    variances = solve(problem, options);
  }
  return variances;
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
  const ResidualNoise noise = noise_at(problem);
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

MaximumLikelihoodResult refine(std::span<const HandEyeObservation> observations,
                               const HandEyeSolution& start,
                               const MaximumLikelihoodOptions& options) {
  PoseProblem problem(observations, start, options);
  const ResidualNoise::Variances variances = solve_without_outliers(problem, options);
  return describe(problem, variances, options);
}

/// With the assumed noise from every start: the one that fits most poses best, whatever the others
/// do. One scale for the eye's noise, that of the first start, makes them comparable.
std::optional<HandEyeSolution> best_start(std::span<const HandEyeObservation> observations,
                                          const std::vector<HandEyeSolution>& starts,
                                          const MaximumLikelihoodOptions& options) {
  const ResidualNoise::Variances assumed = variances_of(options.noise);
  std::vector<HandEyeSolution> solutions;
  std::vector<std::vector<double>> norms;
  double least_median = std::numeric_limits<double>::infinity();
  for (const HandEyeSolution& start : starts) {
    if (!usable(start)) continue;
    PoseProblem problem(observations, start, options);
    problem.noise_holds_at(starts.front().scale_units_per_mm);
    leave_out_far_ones(problem, options);
    problem.minimise(assumed);
    solutions.push_back(problem.solution());
    norms.push_back(problem.norms(assumed));
    least_median = std::min(least_median, median(norms.back()));
  }
  std::optional<HandEyeSolution> best;
  double least_cost = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < solutions.size(); ++i) {
    double cost = 0;
    for (const double norm : norms[i]) {
      cost += square(std::min(norm, kFarFromMedian * least_median));
    }
    if (cost < least_cost) best = solutions[i];
    least_cost = std::min(cost, least_cost);
  }
  return best;
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
  if (!usable(observations) || !usable(start)) return std::nullopt;
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
