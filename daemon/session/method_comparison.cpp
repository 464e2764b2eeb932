// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/method_comparison.hpp"

#include "daemon/handeye/selection.hpp"
#include "daemon/session/stopwatch.hpp"

namespace handeye {

std::vector<MethodResult> compare_methods(std::span<const Method> methods,
                                          std::span<const PosePair> poses, const PoseNoise& noise) {
  const Selection selection = select_movements(poses);
  const HandEyeProblem problem{.poses = poses, .movements = selection.movements, .noise = noise};
  std::vector<MethodResult> results;
  for (const Method& method : methods) {
    const Stopwatch stopwatch;
    MethodResult result{.name = std::string(method.name)};
    result.solution = method.solve(problem);
    result.time_ms = stopwatch.elapsed_ms();
    if (result.solution) result.residuals = seed_residuals(poses, *result.solution);
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace handeye
