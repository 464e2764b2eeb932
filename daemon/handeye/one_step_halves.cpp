// SPDX-License-Identifier: BSD-3-Clause
#include <future>
#include <map>
#include <vector>

#include <Eigen/Dense>

#include "daemon/handeye/halves.hpp"

namespace handeye {
namespace {

constexpr double kHeld = 1e-3;           // of the lens's prior, about the lens that was found
constexpr std::size_t kFewestViews = 2;  // of a point

/// Of each frame: whether it is in the first half of its part.
std::vector<bool> in_first_half(const OneStepProblem& problem) {
  std::map<int, std::size_t> size_of;
  for (const OneStepFrame& frame : problem.frames) ++size_of[frame.part];
  std::map<int, std::size_t> seen_of;
  std::vector<bool> first;
  for (const OneStepFrame& frame : problem.frames) {
    first.push_back(2 * seen_of[frame.part]++ < size_of[frame.part]);
  }
  return first;
}

/// The frames that are `wanted`, and what their keyframes saw.
OneStepProblem only(const OneStepProblem& problem, const std::vector<bool>& is_first, bool wanted) {
  OneStepProblem half{.camera = problem.camera};
  std::vector<int> place_of(problem.frames.size(), -1);
  for (std::size_t k = 0; k < problem.frames.size(); ++k) {
    if (is_first[k] != wanted) continue;
    place_of[k] = static_cast<int>(half.frames.size());
    half.frames.push_back(problem.frames[k]);
  }
  for (const OneStepPoint& point : problem.points) {
    OneStepPoint seen{.part = point.part, .point_scene = point.point_scene};
    for (const OneStepPoint::Observation& observation : point.observations) {
      const int place = place_of[static_cast<std::size_t>(observation.frame)];
      if (place >= 0) seen.observations.push_back({place, observation.pixel});
    }
    if (seen.observations.size() >= kFewestViews) half.points.push_back(std::move(seen));
  }
  return half;
}

/// What the whole found is not found again, so that halves differ by what they saw only.
OneStepOptions as_found(const OneStepResult& whole, OneStepOptions options) {
  if (options.lens) {
    options.lens->mean = lens_vector(whole.camera);
    options.lens->sigma *= kHeld;
  }
  if (options.hand_noise == HandNoiseSource::kEstimated) {
    options.hand_noise = HandNoiseSource::kGiven;
    options.hand_rotation_sigma_rad = whole.hand_rotation_sigma_rad;
    options.hand_translation_sigma_mm = whole.hand_translation_sigma_mm;
  }
  options.image_noise_px = whole.image_noise_px;
  return options;
}

}  // namespace

std::optional<HalvesOfWhole> compare_halves(const OneStepProblem& problem,
                                            const MaximumLikelihoodResult& start,
                                            const OneStepResult& whole,
                                            const OneStepOptions& options) {
  const std::vector<bool> is_first = in_first_half(problem);
  const OneStepOptions held = as_found(whole, options);
  MaximumLikelihoodResult from = start;
  from.solution.hand_from_eye = whole.hand_from_eye;
  const auto solve = [&](bool wanted) {
    return one_step(only(problem, is_first, wanted), from, held);
  };
  auto second_half = std::async(std::launch::async, solve, false);
  const auto first = solve(true);
  const auto second = second_half.get();
  if (!first || !second) return std::nullopt;
  return HalvesOfWhole{
      compare(first->hand_from_eye, second->hand_from_eye, first->covariance + second->covariance),
      whole.covariance};
}

}  // namespace handeye
