// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/robust_solve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "daemon/handeye/noise_fit.hpp"
#include "daemon/handeye/usable.hpp"

namespace handeye {
namespace {

constexpr int kRejections = 3;          // each with what the one before has left
constexpr double kFarFromMedian = 5.0;  // of the norms at the start
constexpr double kScaleSettled = 1e-4;  // change of the log scale that moves no weight
constexpr double kNoiseSettled = 0.01;  // relative change of a variance that moves no answer

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

/// Fewer than determine an answer, or so few that the others might as well be right.
bool too_few(const std::vector<bool>& kept) {
  const auto left = static_cast<std::size_t>(std::count(kept.begin(), kept.end(), true));
  return left < kFewestLikelihoodPoses || 2 * left < kept.size();
}

/// Leaves out what already the start says is far from all others: one pose that is metres off turns
/// the whole scene, whatever the loss.
void leave_out_far_ones(PoseProblem& problem, const MaximumLikelihoodOptions& options) {
  if (!(options.reject > 0)) return;
  const std::vector<double> norms = problem.norms(variances_of(options.noise));
  std::vector<bool> near = within(norms, kFarFromMedian * std::max(median(norms), 1.0));
  if (too_few(near)) return;
  problem.keep(std::move(near));
}

}  // namespace

ResidualNoise::Variances solve_without_outliers(PoseProblem& problem,
                                                const MaximumLikelihoodOptions& options) {
  leave_out_far_ones(problem, options);
  ResidualNoise::Variances variances = solve(problem, options);
  for (int pass = 0; options.reject > 0 && pass < kRejections; ++pass) {
    const std::vector<double> norms = problem.norms(variances);
    std::vector<bool> kept = within(norms, options.reject);
    if (too_few(kept)) kept.assign(norms.size(), true);
    if (kept == problem.kept()) break;
    problem.keep(std::move(kept));
    variances = solve(problem, options);
  }
  return variances;
}

std::optional<HandEyeSolution> best_start(std::span<const HandEyeObservation> observations,
                                          const std::vector<HandEyeSolution>& starts,
                                          const MaximumLikelihoodOptions& options) {
  const ResidualNoise::Variances assumed = variances_of(options.noise);
  std::vector<HandEyeSolution> solutions;
  std::vector<std::vector<double>> norms;
  double least_median = std::numeric_limits<double>::infinity();
  for (const HandEyeSolution& start : starts) {
    if (!is_usable(start)) continue;
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
      cost += std::pow(std::min(norm, kFarFromMedian * least_median), 2);
    }
    if (cost < least_cost) best = solutions[i];
    least_cost = std::min(cost, least_cost);
  }
  return best;
}

}  // namespace handeye
