// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/one_step_check.hpp"

#include <algorithm>
#include <cmath>

namespace handeye {
namespace {

constexpr double kMostChi2 = 4.0;      // per degree of freedom: twice the noise
constexpr double kMostRejected = 0.2;  // share of the hands
/// What the straight line between two samples leaves of their variance, in the mean of the instants
/// between them: the likelihood's hands are looked up so.
constexpr double kShareOfLine = 2.0 / 3.0;

double square(double x) {
  return x * x;
}

std::size_t hands_of(const OneStepProblem& problem) {
  return static_cast<std::size_t>(std::ranges::count_if(
      problem.frames, [](const OneStepFrame& frame) { return frame.hand.has_value(); }));
}

/// Of an answer that fits as well as the likelihood's, against the noise that it was solved with.
double expected_chi2(const OneStepOptions& options, const PoseNoise& of_likelihood) {
  if (options.hand_noise == HandNoiseSource::kMeasured) return 1.0;
  const PoseNoise samples = noise_of_samples(of_likelihood);
  const double rotation = samples.hand_rotation_rad / options.hand_rotation_sigma_rad;
  const double translation = samples.hand_translation_mm / options.hand_translation_sigma_mm;
  return std::max(1.0, 0.5 * (square(rotation) + square(translation)));
}

}  // namespace

PoseNoise noise_of_samples(const PoseNoise& of_likelihood) {
  return {.hand_rotation_rad = of_likelihood.hand_rotation_rad / std::sqrt(kShareOfLine),
          .hand_translation_mm =
              std::hypot(of_likelihood.hand_translation_mm, of_likelihood.eye_translation_mm) /
              std::sqrt(kShareOfLine),
          .eye_rotation_rad = 0.0,
          .eye_translation_mm = 0.0};
}

bool explains_the_hand(const OneStepResult& result, const OneStepProblem& problem,
                       const OneStepOptions& options, const PoseNoise& of_likelihood) {
  const auto hands = static_cast<double>(hands_of(problem));
  return static_cast<double>(result.rejected.size()) <= kMostRejected * hands &&
         result.chi2_per_dof <= kMostChi2 * expected_chi2(options, of_likelihood);
}

}  // namespace handeye
