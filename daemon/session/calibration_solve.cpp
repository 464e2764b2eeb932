// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <future>

#include <fmt/format.h>

#include "daemon/session/calibration_snapshot.hpp"
#include "daemon/session/estimate.hpp"
#include "daemon/session/lens_sensitivity.hpp"
#include "daemon/session/method_comparison.hpp"
#include "daemon/session/offset_check.hpp"
#include "daemon/session/one_step_estimate.hpp"
#include "daemon/session/stopwatch.hpp"
#include "daemon/session/verdict.hpp"

namespace handeye {
namespace {

constexpr std::string_view kOneStep = "one_step";
/// The offset is one of stamps, and these are known no better: the tracker's clock mapped through
/// 1 ms of jitter, the middle of an exposure. Without it offsets of rendered sequences were off by
/// 1.24 of their sigmas (0.073 ms; seeds 1 to 20 and 101 to 120 of `accuracy_table`), of synthetic
/// tracks, whose stamps are exact, by 1.0.
constexpr double kStamps_s = 4e-5;
constexpr std::string_view kWorseTrackerAdvice =
    "The tracker would have to be more than five times as noisy as it is said to be: check that "
    "camera and body sit firmly, the lens, and the tracker's noise in the configuration.";
constexpr std::string_view kStoodStillAdvice =
    "The scope stood still in every image, so the time offset between camera and tracker could not "
    "be found and was not needed: it was taken to be 0.";

/// What one step does not wait for.
struct Besides {
  std::vector<MethodResult> methods;  ///< of the table; the last is the likelihood's
  std::optional<Matrix6d> lens_covariance;
  bool offset_jumped{false};
};

/// The methods of the table on the likelihood's poses, what an uncertain lens adds to its answer,
/// and whether one time offset serves all of it.
Besides look_besides(const CalibrationSnapshot& snapshot, const Estimate& found) {
  Besides besides;
  besides.lens_covariance = lens_covariance(snapshot.reconstruction, found, snapshot.hand);
  besides.offset_jumped = offset_jumped(snapshot.reconstruction.frames, snapshot.hand);
  const std::vector<PosePair> pairs = poses_of_answer(found);
  const std::span<const Method> all = methods(found.scale);
  ComparisonOptions comparison{.scale = found.scale, .noise = found.options.noise};
  if (found.likelihood) {
    // Errors that stay for some frames spoil their answers as they do the likelihood's.
    comparison.sigma = true;
    comparison.sigma_noise = found.likelihood->noise;
    comparison.sigma_factor = std::sqrt(found.likelihood->correlation_inflation);
  }
  besides.methods = compare_methods(all.first(all.size() - 1), pairs, comparison);
  MethodResult& likelihood = besides.methods.emplace_back();
  likelihood.name = all.back().name;
  if (!found.likelihood) return besides;
  likelihood.solution = found.likelihood->solution;
  likelihood.residuals = seed_residuals(pairs, *likelihood.solution);
  likelihood.time_ms = found.time_ms;
  if (besides.lens_covariance) {
    likelihood.sigma = sigma_of(found.likelihood->covariance + *besides.lens_covariance);
  }
  return besides;
}

MethodResult one_step_method(const OneStepEstimate& one_step, const Estimate& found) {
  MethodResult method{.name = std::string(kOneStep), .solution = one_step.solution};
  method.residuals = seed_residuals(poses_of_answer(found), one_step.solution);
  method.time_ms = one_step.time_ms;
  method.sigma = sigma_of(one_step.result.covariance);
  return method;
}

void write_covariance(const Matrix6d& covariance, CalibrationResult& result) {
  result.covariance = covariance;
  const MethodSigma sigma = sigma_of(covariance);
  result.sigma_rotation_deg = sigma.rotation_deg;
  result.sigma_translation_mm = sigma.translation_mm;
}

/// The likelihood's answer; where there is one in one step, that comes over it.
void write_likelihood(const Estimate& found, CalibrationResult& result) {
  if (found.correlation) {
    result.time_offset_s = found.time_offset_s;
    result.time_offset_sigma_s = std::hypot(found.time_offset_sigma_s, kStamps_s);
  }
  if (!found.likelihood) return;
  result.has_estimate = true;
  result.method = result.methods.back().name;
  result.solution = found.likelihood->solution;
  result.residuals = result.methods.back().residuals;
  result.hand_noise =
      SampleNoise{.rotation_deg = deg_from_rad(found.likelihood->noise.hand_rotation_rad),
                  .translation_mm = found.likelihood->noise.hand_translation_mm};
  write_covariance(found.likelihood->covariance, result);
}

void write_one_step(const OneStepEstimate& one_step, const Estimate& found,
                    const Reconstruction& reconstruction, CalibrationResult& result) {
  result.methods.push_back(one_step_method(one_step, found));
  result.method = kOneStep;
  result.solution = one_step.solution;
  result.residuals = result.methods.back().residuals;
  if (found.correlation) {
    result.time_offset_s = one_step.time_offset_s;
    result.time_offset_sigma_s = std::hypot(one_step.result.time_offset_sigma_s, kStamps_s);
  }
  result.hand_noise = hand_noise_of(one_step);
  result.image_noise_px = one_step.result.image_noise_px;
  if (!result.lens) return;
  result.camera = one_step.result.camera;
  result.lens->sigma = lens_sigma_of(one_step, reconstruction);
}

/// Reasons whose advice does not name one motion already.
bool leaves_the_motion_open(Reason reason) {
  return reason == Reason::kSingleAxis || reason == Reason::kUncertain;
}

std::string advice_for(const Finding& finding, const std::optional<Board>& board,
                       const Estimate& found) {
  std::string advice =
      board ? reason_advice(finding.reason, *board) : std::string(reason_advice(finding.reason));
  if (leaves_the_motion_open(finding.reason) && finding.missing != MissingMotion::kNone) {
    advice += fmt::format(" What would help most: {}.", words(finding.missing));
  }
  if (finding.reason == Reason::kUncertain && finding.worse_tracker) {
    advice += fmt::format(" {}", kWorseTrackerAdvice);
  }
  if (found.stood_still && found.likelihood) {
    if (!advice.empty()) advice += ' ';
    advice += kStoodStillAdvice;
  }
  return advice;
}

void write_finding(const Finding& finding, const Estimate& found, const CalibrationOptions& options,
                   CalibrationResult& result) {
  if (finding.judgement && result.has_estimate) write_covariance(finding.covariance, result);
  if (!finding.lens_known && result.lens) result.lens->observable = false;
  result.reason = finding.reason;
  result.verdict = result.reason == Reason::kNone ? Verdict::kAccepted : Verdict::kRefused;
  result.missing = word(finding.missing);
  result.advice = advice_for(finding, options.start.board, found);
}

}  // namespace

SolvedCalibration solve(const CalibrationSnapshot& snapshot) {
  const Stopwatch stopwatch;
  const CalibrationOptions& options = snapshot.options;
  SolvedCalibration solved{snapshot.begun, {}};
  CalibrationResult& result = solved.result;
  const Estimate found =
      estimate(snapshot.reconstruction.frames, snapshot.hand, options.noise, snapshot.scale);
  // Neither sees anything of the other: two threads give what one would.
  auto beside = std::async(std::launch::async, look_besides, std::cref(snapshot), std::cref(found));
  const auto one_step =
      estimate_in_one_step(snapshot.reconstruction, snapshot.hand, found, options.hand_noise);
  Besides besides = beside.get();
  result.methods = std::move(besides.methods);
  solved.lens_covariance = besides.lens_covariance;
  write_likelihood(found, result);
  if (one_step) write_one_step(*one_step, found, snapshot.reconstruction, result);
  const Finding finding = conclude({.frames_received = result.frames.received,
                                    .images = snapshot.images,
                                    .hand_path = snapshot.hand_path,
                                    .reconstruction = snapshot.reconstruction,
                                    .estimate = found,
                                    .one_step = one_step,
                                    .lens_covariance = solved.lens_covariance,
                                    .offset_jumped = besides.offset_jumped,
                                    .noise = options.noise,
                                    .wanted = options.start.wanted});
  if (!finding.lens_known) solved.lens_covariance.reset();
  write_finding(finding, found, options, result);
  result.timings_ms.handeye = stopwatch.elapsed_ms();
  return solved;
}

}  // namespace handeye
