// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/one_step_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/LU>

#include "daemon/geometry/projection.hpp"
#include "daemon/session/one_step_check.hpp"
#include "daemon/session/one_step_problem.hpp"
#include "daemon/session/stopwatch.hpp"
#include "daemon/tracking/bent_window.hpp"

namespace handeye {
namespace {

// One step is linear in the offset within a few milliseconds; look up again beyond this.
constexpr double kOffsetSettled_s = 0.0005;
constexpr int kMostRounds = 3;

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

/// What a lens does to a window, seen under the same angle, on its way from the middle of the image
/// [px]. Where the tracker did not know the lens it is not counted (bent_window.hpp), all features
/// err alike by it, and no covariance of independent tracks knows: the distortion was off by 5.4 of
/// its sigmas, the focal length by 3.6, on 20 s through a lens with k1 = -0.3. Nothing where the
/// lens does not reach.
std::optional<double> bend_from_middle_px(const CameraModel& lens, const Eigen::Vector2d& pixel) {
  const auto before = window_rays(lens, {lens.cx, lens.cy});
  const auto now = window_rays(lens, pixel);
  if (!before || !now) return std::nullopt;
  const Eigen::Matrix2d linear = now->pixel_by_ray * before->pixel_by_ray.inverse();
  return bend_px(lens, *before, {pixel.cast<float>(), linear.cast<float>()}).norm();
}

/// Another focal length and k1 that make a pixel move by as much, and as much again, for they are
/// off in opposite directions (measured: +0.02 % and -0.00027 where these are 0.008 % and 0.0001).
void widen_by_bend(const CameraModel& lens, double bend_px, const Eigen::Vector2d& ray,
                   LensSigma& sigma) {
  bend_px *= 2.0;
  const double focal = focal_px(lens);
  sigma.focal_px = std::hypot(sigma.focal_px, bend_px / ray.norm());
  sigma.k1 = std::hypot(sigma.k1, bend_px / (focal * std::pow(ray.norm(), 3)));
  sigma.distortion_px = std::hypot(sigma.distortion_px, bend_px);
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
  const CameraModel& lens = estimate.result.camera;
  const LensMatrix& covariance = estimate.result.lens_covariance;
  const LensVector sigma = covariance.diagonal().cwiseSqrt();
  // Of the distortion the hand tells next to nothing: it makes nobody surer than the images.
  const LensSigma& of_images = reconstruction.lens.sigma;
  LensSigma result{.focal_px = sigma[kFocal],
                   .centre_px = std::max(sigma[kCentreX], sigma[kCentreY]),
                   .k1 = std::max(sigma[kK1], of_images.k1),
                   .k2 = std::max(sigma[kK2], of_images.k2),
                   .distortion_px = of_images.distortion_px};
  Eigen::Vector2d outermost_ray = Eigen::Vector2d::Zero();
  double most_bend_px = 0.0;
  for (const ScenePoint& point : reconstruction.structure) {
    for (const ScenePoint::Observation& seen : point.observations) {
      const auto ray = unproject(lens, seen.pixel);
      if (!ray) continue;
      result.distortion_px =
          std::max(result.distortion_px, distortion_sigma_px(lens, covariance, *ray));
      if (ray->norm() <= outermost_ray.norm()) continue;
      const auto bend = bend_from_middle_px(lens, seen.pixel);
      if (!bend) continue;
      outermost_ray = *ray;
      most_bend_px = *bend;
    }
  }
  if (result.distortion_px > 0 && most_bend_px > 0) {
    widen_by_bend(lens, most_bend_px, outermost_ray, result);
  }
  return result;
}

}  // namespace handeye
