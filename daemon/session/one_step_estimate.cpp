// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/one_step_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "daemon/session/one_step_check.hpp"
#include "daemon/session/one_step_problem.hpp"
#include "daemon/session/stopwatch.hpp"

namespace handeye {
namespace {

// One step is linear in the offset within a few milliseconds; look up again beyond this.
constexpr double kOffsetSettled_s = 0.0005;
constexpr int kMostRounds = 3;
/// By what neighbouring features are off together, and no covariance of independent tracks knows:
/// windows that strong distortion bends are taken for affine. Without it the distortion was off by
/// 3.6 of its sigmas on 8 s and 5.4 on 20 s of the sequence "distortion" (0.16 px in a corner).
constexpr double kCommonError_px = 0.04;

/// Whether most of the frames that the hand was seen at have the tracker's own word on it.
bool is_measured(const OneStepProblem& problem) {
  const auto with_hand = std::ranges::count_if(
      problem.frames, [](const OneStepFrame& frame) { return frame.hand.has_value(); });
  const auto measured = std::ranges::count_if(problem.frames, [](const OneStepFrame& frame) {
    return frame.hand && frame.hand->sample_covariance;
  });
  return measured > 0 && 2 * measured >= with_hand;
}

/// An estimate of the tracker's noise starts from what explains the likelihood's residuals.
OneStepOptions options_for(const Lens& lens, const Estimate& start, HandNoiseSource hand_noise) {
  OneStepOptions options;
  if (lens.mode != IntrinsicsMode::kFixed) options.lens = lens.prior;
  const bool estimated = hand_noise == HandNoiseSource::kEstimated;
  const PoseNoise noise =
      estimated ? noise_of_samples(start.likelihood->noise) : start.options.noise;
  options.hand_rotation_sigma_rad = noise.hand_rotation_rad;
  options.hand_translation_sigma_mm = noise.hand_translation_mm;
  options.hand_noise = hand_noise;
  options.estimate_time_offset = start.options.estimate_time_offset;
  return options;
}

/// Sum of the squared distances from their mean.
double spread(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) mean += point / static_cast<double>(points.size());
  double sum = 0.0;
  for (const Eigen::Vector3d& point : points) sum += (point - mean).squaredNorm();
  return sum;
}

/// Scene units per mm of a part: its camera's path as reconstructed to its path in the room.
std::optional<double> scale_of(int part, const Reconstruction& reconstruction,
                               const OneStepResult& result) {
  std::vector<Eigen::Vector3d> in_scene;
  std::vector<Eigen::Vector3d> in_room;
  for (std::size_t i = 0; i < reconstruction.frames.size(); ++i) {
    const RegisteredFrame& frame = reconstruction.frames[i];
    if (frame.part != part || !result.eye_from_room[i]) continue;
    in_scene.emplace_back(frame.eye_from_scene.inverse().translation());
    in_room.emplace_back(result.eye_from_room[i]->inverse().translation());
  }
  const double scale = std::sqrt(spread(in_scene) / spread(in_room));
  if (!std::isfinite(scale) || scale <= 0) return std::nullopt;
  return scale;
}

}  // namespace

std::optional<OneStepEstimate> estimate_in_one_step(const Reconstruction& reconstruction,
                                                    const PoseBuffer& hand, const Estimate& start,
                                                    HandNoiseSource hand_noise) {
  if (!start.likelihood || start.scale == ScaleMode::kKnown) return std::nullopt;
  const Stopwatch stopwatch;
  OneStepEstimate estimate{.time_offset_s = start.time_offset_s, .hand_noise = hand_noise};
  estimate.start = *start.likelihood;
  const HandSmoothing smoothed = smoothed_for(reconstruction.frames, hand);
  bool settled = false;
  for (int round = 0; round < kMostRounds && !settled; ++round) {
    estimate.problem = one_step_problem(reconstruction, smoothed, estimate.time_offset_s);
    const OneStepProblem& problem = estimate.problem;
    if (estimate.hand_noise == HandNoiseSource::kMeasured && !is_measured(problem)) {
      estimate.hand_noise = HandNoiseSource::kEstimated;
    }
    estimate.options = options_for(reconstruction.lens, start, estimate.hand_noise);
    auto found = one_step(problem, estimate.start, estimate.options);
    if (!found) return std::nullopt;
    if (!explains_the_hand(*found, problem, estimate.options, start.likelihood->noise)) {
      if (estimate.hand_noise != HandNoiseSource::kMeasured) return std::nullopt;
      estimate.hand_noise = HandNoiseSource::kEstimated;
      continue;
    }
    estimate.result = std::move(*found);
    const double correction_s = estimate.result.time_offset_correction_s;
    estimate.time_offset_s += correction_s;
    estimate.start.solution.hand_from_eye = estimate.result.hand_from_eye;
    settled = !estimate.options.estimate_time_offset || std::abs(correction_s) < kOffsetSettled_s;
  }
  // An offset that runs away has no first order to be corrected by.
  if (!settled) return std::nullopt;
  const auto scale = scale_of(estimate.start.part, reconstruction, estimate.result);
  estimate.solution = {estimate.result.hand_from_eye,
                       scale.value_or(start.likelihood->solution.scale_units_per_mm)};
  estimate.time_ms = stopwatch.elapsed_ms();
  return estimate;
}

SampleNoise hand_noise_of(const OneStepEstimate& estimate) {
  SampleNoise noise{.rotation_deg = deg_from_rad(estimate.result.hand_rotation_sigma_rad),
                    .translation_mm = estimate.result.hand_translation_sigma_mm};
  switch (estimate.hand_noise) {
    case HandNoiseSource::kGiven:
      noise.source = "given";
      break;
    case HandNoiseSource::kMeasured:
      noise.source = "measured";
      break;
    case HandNoiseSource::kEstimated:
      noise.source = "estimated";
      break;
  }
  return noise;
}

LensSigma lens_sigma_of(const OneStepEstimate& estimate, const Reconstruction& reconstruction) {
  const LensMatrix& covariance = estimate.result.lens_covariance;
  const LensVector sigma = covariance.diagonal().cwiseSqrt();
  // Of the distortion the hand tells next to nothing: it makes nobody surer than the images.
  const LensSigma& of_images = reconstruction.lens.sigma;
  LensSigma result{.focal_px = sigma[kFocal],
                   .centre_px = std::max(sigma[kCentreX], sigma[kCentreY]),
                   .k1 = std::max(sigma[kK1], of_images.k1),
                   .k2 = std::max(sigma[kK2], of_images.k2),
                   .distortion_px = of_images.distortion_px};
  for (const ScenePoint& point : reconstruction.structure) {
    for (const ScenePoint::Observation& seen : point.observations) {
      const auto ray = unproject(estimate.result.camera, seen.pixel);
      if (!ray) continue;
      result.distortion_px = std::max(
          result.distortion_px, distortion_sigma_px(estimate.result.camera, covariance, *ray));
    }
  }
  if (result.distortion_px > 0) {
    result.distortion_px = std::hypot(result.distortion_px, kCommonError_px);
  }
  return result;
}

}  // namespace handeye
