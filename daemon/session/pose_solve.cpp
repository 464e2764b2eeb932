// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/pose_solve.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "daemon/handeye/consensus.hpp"
#include "daemon/handeye/judge.hpp"
#include "daemon/handeye/maximum_likelihood.hpp"
#include "daemon/session/method_comparison.hpp"
#include "daemon/session/stopwatch.hpp"
#include "daemon/session/verdict.hpp"
#include "protocol/exit_codes.hpp"

namespace handeye {
namespace {

constexpr std::string_view kAnswer = "maximum_likelihood";

std::vector<Method> chosen_methods(const PoseSolveOptions& options) {
  const std::span<const Method> all = methods(options.scale);
  std::vector<Method> chosen;
  std::vector<std::string_view> names;
  for (const Method& method : all) {
    names.push_back(method.name);
    if (!options.method || *options.method == method.name) chosen.push_back(method);
  }
  if (options.method && chosen.empty()) {
    const bool known = options.scale == ScaleMode::kKnown;
    throw UsageError(fmt::format("no method '{}' for --scale {}; there are: {}", *options.method,
                                 known ? "known" : "unknown", fmt::join(names, ", ")));
  }
  return chosen;
}

/// The answer comes last in either table; it is solved apart, for its covariance.
std::span<const Method> others_of(std::span<const Method> chosen) {
  return chosen.back().name == kAnswer ? chosen.first(chosen.size() - 1) : chosen;
}

void require_plausible(const std::optional<DeviceNoise>& noise, std::string_view device) {
  constexpr double kLeast = 1e-9;
  constexpr double kMost = 1e6;
  const auto plausible = [](double sigma) { return sigma >= kLeast && sigma <= kMost; };
  if (noise && !(plausible(noise->rotation_deg) && plausible(noise->translation_mm))) {
    throw UsageError(
        fmt::format("the noise of the {} is {:g} deg, {:g} mm; each must be from {:g} "
                    "to {:g}",
                    device, noise->rotation_deg, noise->translation_mm, kLeast, kMost));
  }
}

PoseNoise noise_from(const PoseSolveOptions& options) {
  require_plausible(options.hand_noise, "hand");
  require_plausible(options.eye_noise, "eye");
  PoseNoise noise;
  if (options.hand_noise) {
    noise.hand_rotation_rad = rad_from_deg(options.hand_noise->rotation_deg);
    noise.hand_translation_mm = options.hand_noise->translation_mm;
  }
  if (options.eye_noise) {
    noise.eye_rotation_rad = rad_from_deg(options.eye_noise->rotation_deg);
    noise.eye_translation_mm = options.eye_noise->translation_mm;
  }
  return noise;
}

MaximumLikelihoodOptions likelihood_options(const PoseSolveOptions& options) {
  return {.noise = noise_from(options),
          .estimate_noise = !(options.hand_noise && options.eye_noise),
          .account_for_correlation = false,  // rows without time have no neighbours
          .estimate_scale = options.scale == ScaleMode::kUnknown};
}

/// The indices below n that are not in `wrong`, which is ascending.
std::vector<std::size_t> indices_without(std::size_t n, const std::vector<std::size_t>& wrong) {
  std::vector<std::size_t> indices;
  for (std::size_t k = 0; k < n; ++k) {
    if (!std::ranges::binary_search(wrong, k)) indices.push_back(k);
  }
  return indices;
}

/// The likelihood's answer to all poses, and what it took.
struct Answer {
  std::vector<HandEyeObservation> observations;
  std::optional<MaximumLikelihoodResult> likelihood;
  double time_ms{0};
};

Answer answer_for(std::span<const PosePair> poses, const MaximumLikelihoodOptions& options) {
  const Stopwatch stopwatch;
  Answer answer;
  answer.observations.reserve(poses.size());
  for (const PosePair& pair : poses) answer.observations.push_back({.poses = pair});
  answer.likelihood = maximum_likelihood(answer.observations, options);
  answer.time_ms = stopwatch.elapsed_ms();
  return answer;
}

/// As the likelihood's covariance: given noise is believed within what chance explains; beyond it,
/// the factor by which the residuals exceed it.
double excess_over_given(const MaximumLikelihoodResult& result,
                         const MaximumLikelihoodOptions& options) {
  const double unknowns = options.estimate_scale ? 13.0 : 12.0;
  const double freedom = std::max(1.0, 6.0 * static_cast<double>(result.poses_used) - unknowns);
  const double chance = 1.0 + 3.3 * std::sqrt(2.0 / freedom);
  return result.chi2_per_dof > chance ? std::sqrt(result.chi2_per_dof) : 1.0;
}

MethodResult method_result(const Answer& answer, const CalibrationResult& result) {
  MethodResult method{.name = std::string(kAnswer), .time_ms = answer.time_ms};
  if (!result.has_estimate) return method;
  method.solution = result.solution;
  method.residuals = result.residuals;
  method.sigma = MethodSigma{result.sigma_rotation_deg, result.sigma_translation_mm};
  return method;
}

bool is_finite(const CalibrationResult& result) {
  return result.solution.hand_from_eye.matrix().allFinite() &&
         std::isfinite(result.solution.scale_units_per_mm) && result.covariance.allFinite();
}

void write_estimate(const Answer& answer, const Matrix6d& covariance,
                    std::span<const PosePair> poses, CalibrationResult& result) {
  result.has_estimate = true;
  result.method = kAnswer;
  result.solution = answer.likelihood->solution;
  result.covariance = covariance;
  result.sigma_rotation_deg = sigma_rotation_deg(covariance);
  result.sigma_translation_mm = sigma_translation_mm(covariance);
  result.residuals = seed_residuals(poses, result.solution);
}

void write_verdict(const Judgement& judgement, CalibrationResult& result) {
  result.reason = reason_of(judgement.problem);
  result.missing = word(judgement.missing);
  // A number that does not exist is never accepted, wherever it came from.
  if (result.reason == Reason::kNone && !(result.has_estimate && is_finite(result))) {
    result.reason = Reason::kUncertain;
  }
  result.verdict = result.reason == Reason::kNone ? Verdict::kAccepted : Verdict::kRefused;
  result.advice = reason_advice(result.reason);
}

}  // namespace

PoseSolution solve_poses(std::span<const PosePair> poses, const PoseSolveOptions& options) {
  const Stopwatch stopwatch;
  const std::vector<Method> chosen = chosen_methods(options);
  const MaximumLikelihoodOptions solver = likelihood_options(options);
  PoseSolution solution{.scale = options.scale,
                        .poses = poses.size(),
                        .wrong_poses = wrong_poses(poses, {.scale = options.scale}),
                        .noise = solver.noise,
                        .noise_estimated = solver.estimate_noise};
  const std::vector<std::size_t> places = indices_without(poses.size(), solution.wrong_poses);
  std::vector<PosePair> right;
  for (const std::size_t place : places) right.push_back(poses[place]);
  const Answer answer = answer_for(right, solver);
  const Judgement judgement = judge(answer.observations, answer.likelihood,
                                    {.wanted_rotation_deg = options.wanted.rotation_deg,
                                     .wanted_translation_mm = options.wanted.translation_mm,
                                     .solver = solver});

  CalibrationResult& result = solution.calibration;
  result.wanted = options.wanted;
  if (answer.likelihood) {
    write_estimate(answer, judgement.covariance, right, result);
    solution.poses_used = answer.likelihood->poses_used;
    for (const std::size_t k : answer.likelihood->rejected) {
      solution.rejected_poses.push_back(places[k]);
    }
    if (solver.estimate_noise) {
      solution.noise = answer.likelihood->noise;
    } else {
      solution.noise_factor = excess_over_given(*answer.likelihood, solver);
    }
  }
  write_verdict(judgement, result);
  result.methods = compare_methods(others_of(chosen), right,
                                   {.scale = options.scale,
                                    .noise = solution.noise,
                                    .estimate_noise = solver.estimate_noise,
                                    .sigma = answer.likelihood || !solver.estimate_noise,
                                    .sigma_factor = solution.noise_factor});
  if (chosen.back().name == kAnswer) result.methods.push_back(method_result(answer, result));
  result.timings_ms = {.handeye = answer.time_ms, .total = stopwatch.elapsed_ms()};
  return solution;
}

}  // namespace handeye
