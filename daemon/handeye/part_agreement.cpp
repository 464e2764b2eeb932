// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/part_agreement.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/handeye/pose_covariance.hpp"
#include "daemon/handeye/robust_solve.hpp"

namespace handeye {
namespace {

// Of a chi2 with 7 degrees of freedom: by chance never, and by a reconstruction's usual small
// faults hardly, which the inflation is for.
constexpr double kGross = 60.0;
constexpr double kByChance = 3.3;  // standard deviations of a chi2 that are no finding

void leave_out(PoseProblem& problem, std::size_t part) {
  std::vector<bool> kept = problem.kept();
  for (const std::size_t k : problem.parts()[part].members) kept[k] = false;
  problem.keep(std::move(kept));
}

/// The problem of one part, solved by itself with its own noise.
struct Alone {
  PoseProblem problem;
  PartNoise noise;
};

Alone solved_alone(const PoseProblem& all, std::size_t part,
                   const MaximumLikelihoodOptions& options) {
  PoseProblem own = all;
  for (const std::size_t p : parts_in_use(all)) {
    if (p != part) leave_out(own, p);
  }
  PartNoise noise = solve(own, options);
  return {std::move(own), std::move(noise)};
}

double correlation_of(const Alone& alone, std::size_t part) {
  const ResidualNoise noise(alone.problem.unknowns().common().eye_in_hand_mm);
  const Matrix6d whitening = noise.whitening(alone.noise[part]);
  std::vector<Vector6d> whitened;
  for (const Vector6d& residual : alone.problem.residuals(part)) {
    whitened.push_back(whitening * residual);
  }
  return correlation_time({whitened});
}

/// For each part in use; 0 for the others. With the noise that each shows alone: what a
/// contradiction adds must not hide it.
std::vector<double> disagreement(const PoseProblem& problem,
                                 const MaximumLikelihoodOptions& options) {
  std::vector<double> costs(problem.parts().size(), 0.0);
  std::vector<double> correlations(problem.parts().size(), 1.0);
  PartNoise noise(problem.parts().size(), variances_of(options.noise));
  std::vector<double> scales(problem.start_scales().begin(), problem.start_scales().end());
  for (const std::size_t p : parts_in_use(problem)) {
    Alone alone = solved_alone(problem, p, options);
    noise[p] = alone.noise[p];
    scales[p] = alone.problem.solution(p).scale_units_per_mm;
    alone.problem.noise_holds_at(scales);
    costs[p] = alone.problem.cost_of(p, noise);
    if (options.account_for_correlation) correlations[p] = correlation_of(alone, p);
  }
  PoseProblem common = problem;
  common.noise_holds_at(scales);
  common.minimise(noise);
  std::vector<double> chi2(problem.parts().size(), 0.0);
  for (const std::size_t p : parts_in_use(problem)) {
    chi2[p] = std::max(0.0, 2.0 * (common.cost_of(p, noise) - costs[p])) / correlations[p];
  }
  return chi2;
}

double inflation_for(const std::vector<double>& chi2, std::size_t parts, double common_unknowns) {
  double sum = 0;
  for (const double of_part : chi2) sum += of_part;
  const double freedom = common_unknowns * static_cast<double>(parts - 1);
  const bool by_chance = sum <= freedom + kByChance * std::sqrt(2.0 * freedom);
  return by_chance ? 1.0 : sum / freedom;
}

}  // namespace

PartAgreement leave_out_contradicting_parts(PoseProblem& problem, PartNoise& noise,
                                            const MaximumLikelihoodOptions& options) {
  PartAgreement result{.disagreement_chi2 = std::vector<double>(problem.parts().size(), 0.0)};
  const double common_unknowns = options.estimate_time_offset ? 7.0 : 6.0;
  for (std::size_t in_use = parts_in_use(problem).size(); in_use > 1; --in_use) {
    const std::vector<double> chi2 = disagreement(problem, options);
    const auto worst = std::max_element(chi2.begin(), chi2.end());
    if (*worst < kGross) {
      for (const std::size_t p : parts_in_use(problem)) result.disagreement_chi2[p] = chi2[p];
      result.inflation = inflation_for(chi2, in_use, common_unknowns);
      break;
    }
    const auto part = static_cast<std::size_t>(worst - chi2.begin());
    result.disagreement_chi2[part] = *worst;
    leave_out(problem, part);
    noise = solve_without_outliers(problem, options);
  }
  return result;
}

}  // namespace handeye
