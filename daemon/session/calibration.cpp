// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/calibration.hpp"

#include <algorithm>
#include <cmath>

#include "daemon/session/guidance.hpp"
#include "daemon/session/lens_sensitivity.hpp"
#include "daemon/session/method_comparison.hpp"
#include "daemon/session/stopwatch.hpp"
#include "daemon/session/verdict.hpp"

namespace handeye {
namespace {

// On the way an estimate is only for orientation; so many frames give it fast enough.
constexpr std::size_t kFramesOnTheWay = 150;

constexpr std::string_view kStoodStillAdvice =
    "The scope stood still in every image, so the time offset between camera and tracker could not "
    "be found and was not needed: it was taken to be 0.";

std::vector<RegisteredFrame> thinned(const std::vector<RegisteredFrame>& frames,
                                     std::size_t at_most) {
  if (frames.size() <= at_most) return frames;
  std::vector<RegisteredFrame> kept;
  kept.reserve(at_most);
  for (std::size_t i = 0; i < at_most; ++i) kept.push_back(frames[i * frames.size() / at_most]);
  return kept;
}

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

/// A lens that was not given is the answer's, with what it is worth.
void write_lens(const Lens& lens, CalibrationResult& result) {
  if (lens.mode == IntrinsicsMode::kFixed) return;
  result.camera = lens.camera;
  result.camera_source = lens.mode == IntrinsicsMode::kRefine ? "refined" : "estimated";
  result.lens = LensQuality{lens.sigma, lens.observable};
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

}  // namespace

Calibration::Calibration(const CalibrationOptions& options)
    : options_(options),
      eye_(make_eye_source(options.start.board, options.camera, options.intrinsics,
                           options.reconstruction)),
      hand_({.capacity = options.hand_capacity}) {
  if (is_lens_given()) lens_covariance_ = Matrix6d::Zero();
}

void Calibration::add_hand(const HandSample& sample) {
  hand_.push(sample);
  hand_path_.add(sample);
  hand_hidden_ = !sample.tracked;
}

void Calibration::add_frame(const TrackedFrame& frame) {
  const Stopwatch stopwatch;
  ++frames_;
  images_.add(frame.condition);
  features_recent_ = static_cast<int>(frame.observations.size());
  features_ += features_recent_;
  // A gap, not a loss: what was tracked before is likely to be there after it.
  if (!shows_nothing(frame.condition)) state_ = eye_->add(frame);
  reconstruction_ms_ += stopwatch.elapsed_ms();
}

CalibrationProgress Calibration::progress() const {
  CalibrationProgress progress;
  progress.keyframes = eye_->keyframes();
  progress.rotation_coverage_deg = hand_path_.rotation_coverage_deg();
  progress.translation_coverage_mm = hand_path_.translation_coverage_mm();
  progress.guidance = guidance_for({.board = options_.start.board,
                                    .board_seen = eye_->keyframes() > 0,
                                    .any_frame = frames_ > 0,
                                    .hand_hidden = hand_hidden_,
                                    .images = images_.recent(),
                                    .features_recent = static_cast<double>(features_recent_),
                                    .state = state_,
                                    .rotation_coverage_deg = progress.rotation_coverage_deg,
                                    .second_axis_deg = hand_path_.second_axis_deg(),
                                    .translation_coverage_mm = progress.translation_coverage_mm});
  const std::vector<RegisteredFrame> frames = thinned(eye_->current().frames, kFramesOnTheWay);
  const Estimate estimate_so_far = estimate(frames, hand_, options_.noise, eye_->scale());
  tell_sigma(estimate_so_far, progress);
  return progress;
}

void Calibration::tell_sigma(const Estimate& so_far, CalibrationProgress& progress) const {
  if (!so_far.likelihood) return;
  if (!is_lens_given() && hand_contradicts_lens(so_far.observations)) return;
  const Matrix6d& covariance = so_far.likelihood->covariance;
  progress.sigma_beside_lens =
      MethodSigma{sigma_rotation_deg(covariance), sigma_translation_mm(covariance)};
  if (!lens_covariance_) return;
  progress.sigma_rotation_deg = sigma_rotation_deg(covariance + *lens_covariance_);
  progress.sigma_translation_mm = sigma_translation_mm(covariance + *lens_covariance_);
}

CalibrationResult Calibration::solve() {
  CalibrationResult result = begin_result();
  const Reconstruction reconstruction = reconstruct(result);
  const Stopwatch stopwatch;
  const Estimate found = estimate(reconstruction.frames, hand_, options_.noise, eye_->scale());
  write_estimate(found, options_.noise, result);
  lens_covariance_ = lens_covariance(reconstruction, found, hand_);
  const Finding finding = conclude({.frames_received = frames_,
                                    .images = images_,
                                    .hand_path = hand_path_.room_from_hand(),
                                    .reconstruction = reconstruction,
                                    .estimate = found,
                                    .lens_covariance = lens_covariance_,
                                    .noise = options_.noise,
                                    .wanted = options_.start.wanted});
  if (found.likelihood && finding.judgement) write_covariance(finding.covariance, result);
  if (!finding.lens_known) {
    lens_covariance_.reset();
    if (result.lens) result.lens->observable = false;
  }
  result.reason = finding.reason;
  result.verdict = result.reason == Reason::kNone ? Verdict::kAccepted : Verdict::kRefused;
  result.advice = advice_for(result.reason, found);
  result.timings_ms.handeye = stopwatch.elapsed_ms();
  return result;
}

std::string Calibration::advice_for(Reason reason, const Estimate& found) const {
  const std::optional<Board>& board = options_.start.board;
  std::string advice = board ? reason_advice(reason, *board) : std::string(reason_advice(reason));
  if (!found.stood_still || !found.likelihood) return advice;
  if (!advice.empty()) advice += ' ';
  return advice + std::string(kStoodStillAdvice);
}

CalibrationResult Calibration::begin_result() const {
  CalibrationResult result;
  result.request_id = options_.start.request_id;
  result.body_id = options_.start.body_id;
  result.wanted = options_.start.wanted;
  result.board = options_.start.board;
  result.camera = options_.camera;
  result.frames.received = frames_;
  result.frames.dark = images_.count(ImageCondition::kDark);
  result.frames.frozen = images_.count(ImageCondition::kFrozen);
  result.frames.bright = images_.count(ImageCondition::kBright);
  result.frames.blurred = images_.count(ImageCondition::kBlurred);
  result.frames.interlaced = images_.count(ImageCondition::kInterlaced);
  if (frames_ > 0) {
    result.features.tracked_mean = static_cast<double>(features_) / static_cast<double>(frames_);
  }
  return result;
}

Reconstruction Calibration::reconstruct(CalibrationResult& result) {
  const Stopwatch stopwatch;
  Reconstruction reconstruction = eye_->finish();
  reconstruction_ms_ += stopwatch.elapsed_ms();
  result.frames.used = static_cast<std::int64_t>(reconstruction.frames.size());
  result.frames.keyframes =
      std::ranges::count_if(reconstruction.frames, &RegisteredFrame::keyframe);
  result.features.points = reconstruction.points;
  result.reprojection_px = reconstruction.reprojection_px;
  write_lens(reconstruction.lens, result);
  result.timings_ms.reconstruction = reconstruction_ms_;
  return reconstruction;
}

}  // namespace handeye
