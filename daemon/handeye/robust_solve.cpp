// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/robust_solve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "daemon/geometry/median.hpp"
#include "daemon/handeye/noise_fit.hpp"
#include "daemon/handeye/usable.hpp"

namespace handeye {
namespace {

constexpr int kRejections = 3;          // each with what the one before has left
constexpr double kFarFromMedian = 5.0;  // of the norms at the start
constexpr double kScaleSettled = 1e-4;  // change of the log scale that moves no weight
constexpr double kNoiseSettled = 0.01;  // relative change of a variance that moves no answer

PartNoise assumed_noise(const PoseProblem& problem, const MaximumLikelihoodOptions& options) {
  return PartNoise(problem.parts().size(), variances_of(options.noise));
}

std::vector<double> log_scales(const PoseProblem& problem) {
  std::vector<double> result;
  for (std::size_t p = 0; p < problem.parts().size(); ++p) {
    result.push_back(problem.unknowns().of(p).log_scale);
  }
  return result;
}

bool settled(const ResidualNoise::Variances& now, const ResidualNoise::Variances& before) {
  const auto near = [](double x, double y) { return std::abs(x - y) <= kNoiseSettled * y; };
  return near(now.hand_rotation, before.hand_rotation) &&
         near(now.eye_rotation, before.eye_rotation) && near(now.translation, before.translation);
}

bool settled(const PoseProblem& problem, const PartNoise& noise, const PartNoise& noise_before,
             const std::vector<double>& log_scales_before) {
  const std::vector<double> now = log_scales(problem);
  for (std::size_t p = 0; p < noise.size(); ++p) {
    if (!settled(noise[p], noise_before[p]) ||
        std::abs(now[p] - log_scales_before[p]) >= kScaleSettled) {
      return false;
    }
  }
  return true;
}

/// Part by part: each reconstruction errs in its own way.
PartNoise fitted_noise(const PoseProblem& problem, const MaximumLikelihoodOptions& options,
                       const PartNoise& before) {
  const ResidualNoise noise(problem.unknowns().common().eye_in_hand_mm);
  PartNoise fitted = before;
  for (std::size_t p = 0; p < fitted.size(); ++p) {
    if (!problem.in_use(p)) continue;
    fitted[p] = fit_noise(problem.residuals(p), noise, problem.parameters_of(p), options.huber,
                          variances_of(options.noise), before[p]);
  }
  return fitted;
}

std::vector<bool> within(const std::vector<double>& norms, double limit) {
  std::vector<bool> result;
  result.reserve(norms.size());
  for (const double norm : norms) result.push_back(norm <= limit);
  return result;
}

/// Of the norms, those of a part.
std::vector<double> of_part(const std::vector<double>& norms, const Part& part) {
  std::vector<double> result;
  for (const std::size_t k : part.members) result.push_back(norms[k]);
  return result;
}

/// Of all poses of the parts in use; those of the others are infinite in every solution.
std::vector<double> norms_in_use(const PoseProblem& problem, const PartNoise& noise) {
  const std::vector<double> norms = problem.norms(noise);
  std::vector<double> result;
  for (const std::size_t p : parts_in_use(problem)) {
    for (const std::size_t k : problem.parts()[p].members) result.push_back(norms[k]);
  }
  return result;
}

void set(std::vector<bool>& kept, const Part& part, const std::vector<bool>& of_members) {
  for (std::size_t m = 0; m < part.members.size(); ++m) kept[part.members[m]] = of_members[m];
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
  const std::vector<double> norms = problem.norms(assumed_noise(problem, options));
  std::vector<bool> kept = problem.kept();
  for (std::size_t p = 0; p < problem.parts().size(); ++p) {
    if (!problem.in_use(p)) continue;
    const Part& part = problem.parts()[p];
    const std::vector<double> own = of_part(norms, part);
    const std::vector<bool> near = within(own, kFarFromMedian * std::max(median(own), 1.0));
    if (!too_few(near)) set(kept, part, near);
  }
  problem.keep(std::move(kept));
}

/// What the noise explains; of a part of which it explains too little, all.
std::vector<bool> explained(const PoseProblem& problem, const PartNoise& noise, double limit) {
  const std::vector<double> norms = problem.norms(noise);
  std::vector<bool> kept(norms.size(), false);
  for (std::size_t p = 0; p < problem.parts().size(); ++p) {
    if (!problem.in_use(p)) continue;
    const Part& part = problem.parts()[p];
    std::vector<bool> near = within(of_part(norms, part), limit);
    if (too_few(near)) near.assign(near.size(), true);
    set(kept, part, near);
  }
  return kept;
}

}  // namespace

PartNoise solve(PoseProblem& problem, const MaximumLikelihoodOptions& options) {
  PartNoise noise = assumed_noise(problem, options);
  problem.minimise(noise);
  for (int round = 1; round < options.rounds; ++round) {
    const PartNoise before = noise;
    const std::vector<double> log_scales_before = log_scales(problem);
    if (options.estimate_noise) noise = fitted_noise(problem, options, before);
    problem.minimise(noise);
    if (settled(problem, noise, before, log_scales_before)) break;
  }
  return noise;
}

PartNoise solve_without_outliers(PoseProblem& problem, const MaximumLikelihoodOptions& options) {
  leave_out_far_ones(problem, options);
  PartNoise noise = solve(problem, options);
  for (int pass = 0; options.reject > 0 && pass < kRejections; ++pass) {
    std::vector<bool> kept = explained(problem, noise, options.reject);
    if (kept == problem.kept()) break;
    problem.keep(std::move(kept));
    noise = solve(problem, options);
  }
  return noise;
}

std::optional<HandEyeSolution> best_start(std::span<const HandEyeObservation> observations,
                                          const std::vector<HandEyeSolution>& starts,
                                          const MaximumLikelihoodOptions& options) {
  std::vector<HandEyeSolution> solutions;
  std::vector<double> scales_of_noise;
  std::vector<std::vector<double>> norms;
  double least_median = std::numeric_limits<double>::infinity();
  for (const HandEyeSolution& start : starts) {
    if (!is_usable(start)) continue;
    PoseProblem problem(observations, start, options);
    if (scales_of_noise.empty()) {
      scales_of_noise.assign(problem.start_scales().begin(), problem.start_scales().end());
    }
    problem.noise_holds_at(scales_of_noise);
    const PartNoise assumed = assumed_noise(problem, options);
    leave_out_far_ones(problem, options);
    problem.minimise(assumed);
    solutions.push_back(problem.solution(0));
    norms.push_back(norms_in_use(problem, assumed));
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
