// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/method_comparison.hpp"

#include "daemon/handeye/maximum_likelihood.hpp"
#include "daemon/handeye/sandwich.hpp"
#include "daemon/handeye/selection.hpp"
#include "daemon/session/stopwatch.hpp"

namespace handeye {
namespace {

MethodResult run(const Method& method, const HandEyeProblem& problem) {
  const Stopwatch stopwatch;
  MethodResult result{.name = std::string(method.name)};
  result.solution = method.solve(problem);
  result.time_ms = stopwatch.elapsed_ms();
  if (result.solution) result.residuals = seed_residuals(problem.poses, *result.solution);
  return result;
}

std::optional<MethodSigma> sigma_of(const Method& method, const HandEyeSolution& solution,
                                    std::span<const PosePair> poses, const Selection& selection,
                                    const ComparisonOptions& options) {
  const PoseNoise noise = options.sigma_noise.value_or(options.noise);
  const auto covariance = sandwich_covariance(method, poses, selection.pairs, solution, noise);
  if (!covariance || !covariance->allFinite()) return std::nullopt;
  return MethodSigma{options.sigma_factor * sigma_rotation_deg(*covariance),
                     options.sigma_factor * sigma_translation_mm(*covariance)};
}

}  // namespace

MethodSigma sigma_of(const Matrix6d& covariance) {
  return {sigma_rotation_deg(covariance), sigma_translation_mm(covariance)};
}

std::vector<MethodResult> compare_methods(std::span<const Method> methods,
                                          std::span<const PosePair> poses,
                                          const ComparisonOptions& options) {
  const Selection selection = select_movements(poses, {.scale = options.scale});
  const HandEyeProblem problem{.poses = poses,
                               .movements = selection.movements,
                               .noise = options.noise,
                               .estimate_noise = options.estimate_noise};
  std::vector<MethodResult> results;
  for (const Method& method : methods) {
    MethodResult result = run(method, problem);
    if (options.sigma && result.solution) {
      result.sigma = sigma_of(method, *result.solution, poses, selection, options);
    }
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace handeye
