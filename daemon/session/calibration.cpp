// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/calibration.hpp"

#include <algorithm>

#include "daemon/session/stopwatch.hpp"
#include "daemon/sync/clock_hindsight.hpp"

namespace handeye {
namespace {

// On the way an answer is only for orientation; so many frames give it fast enough.
constexpr std::size_t kFramesOnTheWay = 150;

std::vector<RegisteredFrame> thinned(const std::vector<RegisteredFrame>& frames,
                                     std::size_t at_most) {
  if (frames.size() <= at_most) return frames;
  std::vector<RegisteredFrame> kept;
  kept.reserve(at_most);
  for (std::size_t i = 0; i < at_most; ++i) kept.push_back(frames[i * frames.size() / at_most]);
  return kept;
}

/// A lens that was not given is the answer's, with what it is worth.
void write_lens(const Lens& lens, CalibrationResult& result) {
  if (lens.mode == IntrinsicsMode::kFixed) return;
  result.camera = lens.camera;
  result.camera_source = lens.mode == IntrinsicsMode::kRefine ? "refined" : "estimated";
  result.lens = LensQuality{lens.sigma, lens.observable};
}

}  // namespace

Calibration::Calibration(const CalibrationOptions& options)
    : options_(options),
      eye_(make_eye_source(options.start.board, options.camera, options.intrinsics,
                           options.reconstruction)),
      hand_({.capacity = options.hand_capacity}) {
  if (options_.is_lens_given()) lens_covariance_ = Matrix6d::Zero();
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

Situation Calibration::situation() const {
  return {.board = options_.start.board,
          .any_frame = frames_ > 0,
          .hand_hidden = hand_hidden_,
          .images = images_.recent(),
          .features_recent = static_cast<double>(features_recent_),
          .state = state_,
          .keyframes = eye_->keyframes(),
          .rotation_coverage_deg = hand_path_.rotation_coverage_deg(),
          .second_axis_deg = hand_path_.second_axis_deg(),
          .translation_coverage_mm = hand_path_.translation_coverage_mm()};
}

ProvisionalSnapshot Calibration::outline() const {
  return {.frames = thinned(eye_->current().frames, kFramesOnTheWay),
          .hand = with_hindsight(hand_),
          .noise = options_.noise,
          .scale = eye_->scale(),
          .wanted = options_.start.wanted,
          .lens_given = options_.is_lens_given(),
          .lens_covariance = lens_covariance_};
}

CalibrationSnapshot Calibration::snapshot() {
  CalibrationSnapshot snapshot{
      .options = options_,
      .begun = begin_result(),
      .reconstruction = {},
      .scale = eye_->scale(),
      .hand = with_hindsight(hand_),
      .hand_path = {hand_path_.room_from_hand().begin(), hand_path_.room_from_hand().end()},
      .images = images_};
  snapshot.reconstruction = reconstruct(snapshot.begun);
  return snapshot;
}

CalibrationResult Calibration::solve() {
  SolvedCalibration outcome = handeye::solve(snapshot());
  learn(outcome);
  return std::move(outcome.result);
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
