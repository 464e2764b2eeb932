// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/one_step/one_step.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/handeye/one_step/hand_term.hpp"
#include "daemon/handeye/one_step/metric_covariance.hpp"
#include "daemon/handeye/one_step/metric_problem.hpp"
#include "daemon/handeye/one_step/metric_scene.hpp"
#include "daemon/handeye/one_step/noise_estimate.hpp"
#include "daemon/handeye/one_step/noise_rounds.hpp"

namespace handeye {
namespace {

bool options_are_usable(const OneStepOptions& options) {
  const auto good = [](double sigma) { return std::isnormal(sigma) && sigma > 0; };
  const bool lens =
      !options.lens || (options.lens->mean.allFinite() &&
                        std::all_of(options.lens->sigma.begin(), options.lens->sigma.end(), good));
  return lens && good(options.hand_rotation_sigma_rad) && good(options.hand_translation_sigma_mm) &&
         good(options.image_noise_px.value_or(1.0)) && good(options.time_offset_prior_s) &&
         good(options.huber) && good(options.reject);
}

/// Degrees of freedom of the tracker's residuals.
double hand_freedom(const MetricProblem& problem) {
  return std::max(
      1.0, 6.0 * static_cast<double>(problem.hand_rows().size()) - hand_leverage(problem).whitened);
}

/// Against the noise of the options.
double chi2_as_assumed(const MetricProblem& problem) {
  const OneStepOptions& options = problem.options();
  const MetricNoise assumed{problem.noise().image_px,
                            options.hand_rotation_sigma_rad,
                            options.hand_translation_sigma_mm,
                            {}};
  const HandWeights weights =
      hand_weights(problem.scene(), problem.eyes(), problem.state(), assumed,
                   options.hand_noise == HandNoiseSource::kMeasured);
  double chi2 = 0;
  for (const HandRow& row : problem.hand_rows()) {
    const HandAtFrame& hand = *problem.scene().frames[row.frame].hand;
    chi2 += (weights.whitenings[row.frame] *
             hand_residual(hand, problem.eyes()[row.frame], problem.state()))
                .squaredNorm();
  }
  return chi2;
}

/// The noise of the samples as it was used: where each has its own, the root of their mean.
void write_hand_noise(const MetricProblem& problem, OneStepResult& result) {
  Vector6d variances = Vector6d::Zero();
  const auto n = static_cast<double>(problem.hand_rows().size());
  for (const HandRow& row : problem.hand_rows()) {
    variances += sample_covariance(*problem.scene().frames[row.frame].hand, problem.noise(),
                                   problem.options().hand_noise == HandNoiseSource::kMeasured)
                     .diagonal() /
                 n;
  }
  result.hand_rotation_sigma_rad = std::sqrt(variances.head<3>().mean());
  result.hand_translation_sigma_mm = std::sqrt(variances.tail<3>().mean());
}

void write_frames(const OneStepProblem& given, const MetricProblem& problem,
                  OneStepResult& result) {
  const MetricScene& scene = problem.scene();
  result.eye_from_room.resize(given.frames.size());
  for (std::size_t k = 0; k < scene.frames.size(); ++k) {
    Pose room_from_eye = problem.eyes()[k];
    room_from_eye.translation() += scene.centre_mm;
    result.eye_from_room[scene.frames[k].frame] = room_from_eye.inverse();
    if (scene.frames[k].hand && !problem.kept()[k]) {
      result.rejected.push_back(scene.frames[k].frame);
    }
  }
}

OneStepResult describe(const OneStepProblem& given, const MetricProblem& problem) {
  const double freedom = hand_freedom(problem);
  const MetricCovariance covariance = metric_covariance(problem, freedom);
  const MetricState& state = problem.state();
  OneStepResult result;
  result.hand_from_eye = state.hand_from_eye;
  result.covariance = covariance.covariance.topLeftCorner<6, 6>();
  result.log_scale_sigma = covariance.log_scale_sigma;
  result.correlation_inflation = covariance.correlation_inflation;
  result.time_offset_correction_s = state.time_offset_s;
  result.time_offset_sigma_s = std::sqrt(covariance.covariance(kTimeInCommon, kTimeInCommon));
  result.camera = state.camera;
  result.lens_covariance =
      covariance.covariance.bottomRightCorner<kLensParameters, kLensParameters>();
  write_hand_noise(problem, result);
  result.image_noise_px = image_noise_seen_px(problem);
  result.reprojection_px =
      std::sqrt(problem.image_squares() / static_cast<double>(problem.scene().observations.size()));
  result.chi2_per_dof = chi2_as_assumed(problem) / freedom;
  result.iterations = problem.iterations();
  write_frames(given, problem, result);
  return result;
}

}  // namespace

std::optional<OneStepResult> one_step(const OneStepProblem& problem,
                                      const MaximumLikelihoodResult& start,
                                      const OneStepOptions& options) {
  if (!options_are_usable(options)) return std::nullopt;
  const auto scene = metric_scene(problem, start);
  if (!scene) return std::nullopt;
  MetricProblem metric(*scene, options);
  if (!minimise_with_noise(metric)) return std::nullopt;
  OneStepResult result = describe(problem, metric);
  if (!result.covariance.allFinite() || !result.hand_from_eye.matrix().allFinite() ||
      metric.hand_rows().size() < 3) {
    return std::nullopt;
  }
  return result;
}

}  // namespace handeye
