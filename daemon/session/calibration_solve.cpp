// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "daemon/session/calibration_snapshot.hpp"
#include "daemon/session/estimate.hpp"
#include "daemon/session/lens_sensitivity.hpp"
#include "daemon/session/method_comparison.hpp"
#include "daemon/session/stopwatch.hpp"
#include "daemon/session/verdict.hpp"

namespace handeye {
namespace {

constexpr std::string_view kStoodStillAdvice =
    "The scope stood still in every image, so the time offset between camera and tracker could not "
    "be found and was not needed: it was taken to be 0.";

/// Every method's answer to the same poses; the last is the one that this calibration gives.
std::vector<MethodResult> methods_of(const Estimate& estimate, const PoseNoise& noise) {
  const std::vector<PosePair> pairs = poses_of_answer(estimate);
  const std::span<const Method> all = methods(estimate.scale);
  std::vector<MethodResult> results =
      compare_methods(all.first(all.size() - 1), pairs, noise, estimate.scale);
  MethodResult answer{.name = std::string(all.back().name)};
  if (estimate.likelihood) {
    answer.solution = estimate.likelihood->solution;
    answer.residuals = seed_residuals(pairs, *answer.solution);
    answer.time_ms = estimate.time_ms;
  }
  results.push_back(std::move(answer));
  return results;
}

void write_covariance(const Matrix6d& covariance, CalibrationResult& result) {
  result.covariance = covariance;
  result.sigma_rotation_deg = sigma_rotation_deg(covariance);
  result.sigma_translation_mm = sigma_translation_mm(covariance);
}

void write_estimate(const Estimate& estimate, const PoseNoise& noise, CalibrationResult& result) {
  result.methods = methods_of(estimate, noise);
  if (estimate.correlation) {
    result.time_offset_s = estimate.time_offset_s;
    result.time_offset_sigma_s = estimate.time_offset_sigma_s;
  }
  if (!estimate.likelihood) return;
  result.has_estimate = true;
  result.solution = estimate.likelihood->solution;
  write_covariance(estimate.likelihood->covariance, result);
  result.residuals = result.methods.back().residuals;
}

std::string advice_for(Reason reason, const std::optional<Board>& board, const Estimate& found) {
  std::string advice = board ? reason_advice(reason, *board) : std::string(reason_advice(reason));
  if (!found.stood_still || !found.likelihood) return advice;
  if (!advice.empty()) advice += ' ';
  return advice + std::string(kStoodStillAdvice);
}

}  // namespace

SolvedCalibration solve(const CalibrationSnapshot& snapshot) {
  const Stopwatch stopwatch;
  const CalibrationOptions& options = snapshot.options;
  SolvedCalibration outcome{snapshot.begun, {}};
  CalibrationResult& result = outcome.result;
  const Estimate found =
      estimate(snapshot.reconstruction.frames, snapshot.hand, options.noise, snapshot.scale);
  write_estimate(found, options.noise, result);
  outcome.lens_covariance = lens_covariance(snapshot.reconstruction, found, snapshot.hand);
  const Finding finding = conclude({.frames_received = result.frames.received,
                                    .images = snapshot.images,
                                    .hand_path = snapshot.hand_path,
                                    .reconstruction = snapshot.reconstruction,
                                    .estimate = found,
                                    .one_step = std::nullopt,
                                    .lens_covariance = outcome.lens_covariance,
                                    .noise = options.noise,
                                    .wanted = options.start.wanted});
  if (found.likelihood && finding.judgement) write_covariance(finding.covariance, result);
  if (!finding.lens_known) {
    outcome.lens_covariance.reset();
    if (result.lens) result.lens->observable = false;
  }
  result.reason = finding.reason;
  result.verdict = result.reason == Reason::kNone ? Verdict::kAccepted : Verdict::kRefused;
  result.advice = advice_for(result.reason, options.start.board, found);
  result.timings_ms.handeye = stopwatch.elapsed_ms();
  return outcome;
}

}  // namespace handeye
