// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/method_comparison.hpp"

#include "daemon/handeye/selection.hpp"
#include "daemon/session/stopwatch.hpp"

namespace handeye {

MethodResult run_method(const Method& method, const HandEyeProblem& problem) {
  const Stopwatch stopwatch;
  MethodResult result{.name = std::string(method.name)};
  result.solution = method.solve(problem);
  result.time_ms = stopwatch.elapsed_ms();
  if (result.solution) result.residuals = seed_residuals(problem.poses, *result.solution);
  return result;
}

std::vector<MethodResult> compare_methods(std::span<const Method> methods,
                                          std::span<const PosePair> poses, const PoseNoise& noise,
                                          ScaleMode scale) {
  const Selection selection = select_movements(poses, {.scale = scale});
  const HandEyeProblem problem{.poses = poses, .movements = selection.movements, .noise = noise};
  std::vector<MethodResult> results;
  for (const Method& method : methods) results.push_back(run_method(method, problem));
  return results;
}

}  // namespace handeye
