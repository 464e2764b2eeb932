// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/calibration_watch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace handeye {
namespace {

/// The samples after a frame come within the tracker's period and latency.
constexpr std::size_t kMostPending = 32;
constexpr std::size_t kHandSamples = 1024;
/// Looks that fit nothing, one in so many of which is followed by a search.
constexpr int kSearchEvery = 3;
/// By letting go of the calibration; chance gains as much once in 400 looks.
constexpr double kSuspiciousGain = 20.0;

/// A calibration is never held more tightly than this.
constexpr double kTightest_rad = 0.0007;
constexpr double kTightest_mm = 0.3;
/// Two looks at one turn of the head agree within this.
constexpr double kSameTurn_rad = 0.5 * kPi / 180.0;

double seconds(std::int64_t ns) {
  return 1e-9 * static_cast<double>(ns);
}

WatchFitOptions fit_options(const WatchedCalibration& calibration, const WatchOptions& options) {
  const double focal_px = 0.5 * (calibration.camera.fx + calibration.camera.fy);
  return {
      .image_noise = calibration.image_noise_px / focal_px,
      .time_offset_s = options.time_offset_sigma_s,
      .held_rotation_rad = std::max(
          kTightest_rad, std::sqrt(calibration.covariance.topLeftCorner<3, 3>().trace() / 3.0)),
      .held_translation_mm = std::max(
          kTightest_mm, std::sqrt(calibration.covariance.bottomRightCorner<3, 3>().trace() / 3.0))};
}

}  // namespace

CalibrationWatch::CalibrationWatch(WatchedCalibration calibration, const WatchOptions& options)
    : calibration_(std::move(calibration)),
      options_(options),
      fit_options_(fit_options(calibration_, options)),
      hand_({.capacity = kHandSamples}) {}

void CalibrationWatch::add_hand(const HandSample& sample) {
  hand_.push(sample);
}

void CalibrationWatch::add_frame(const TrackedFrame& frame) {
  if (pending_.size() == kMostPending) pending_.pop_front();
  pending_.push_back(frame);
  take_pending();
}

void CalibrationWatch::take_pending() {
  const auto offset_ns = static_cast<std::int64_t>(1e9 * calibration_.time_offset_s);
  while (!pending_.empty()) {
    const TrackedFrame& frame = pending_.front();
    const HandLookup hand = hand_.lookup(frame.timestamp_ns - offset_ns);
    if (hand.status == LookupStatus::kTooNew || hand.status == LookupStatus::kEmpty) return;
    if (hand.status == LookupStatus::kOk && keeps(frame, hand.room_from_hand)) keep(frame, hand);
    pending_.pop_front();
  }
}

bool CalibrationWatch::keeps(const TrackedFrame& frame, const Pose& room_from_hand) const {
  if (shows_nothing(frame.condition) || frame.observations.empty()) return false;
  if (window_.empty()) return true;
  const WatchFrame& last = window_.back();
  if (frame.timestamp_ns - last.timestamp_ns < options_.keep_every_ns) return false;
  const double turn_rad = rotation_angle_rad(last.room_from_hand.linear(), room_from_hand.linear());
  const double shift_mm = (last.room_from_hand.translation() - room_from_hand.translation()).norm();
  return deg_from_rad(turn_rad) > options_.keep_turn_deg || shift_mm > options_.keep_shift_mm;
}

void CalibrationWatch::keep(const TrackedFrame& frame, const HandLookup& hand) {
  const auto too_old = std::ranges::find_if(window_, [&](const WatchFrame& kept) {
    return frame.timestamp_ns - kept.timestamp_ns <= options_.window_age_ns;
  });
  window_.erase(window_.begin(), too_old);
  if (window_.size() == options_.window_frames) window_.erase(window_.begin());
  window_.push_back(make_watch_frame(calibration_.camera, frame, hand, calibration_.hand_noise));
  ++since_look_;
  if (is_look_due()) look();
}

bool CalibrationWatch::is_look_due() const {
  return window_.size() >= options_.short_frames &&
         since_look_ >= (contradicted_ ? options_.look_again_after : options_.look_every);
}

void CalibrationWatch::look() {
  ++looks_;
  since_look_ = 0;
  const WatchEvidence evidence = examine();
  contradicted_ = evidence.kind == WatchEvidence::Kind::kContradicts;
  if (evidence.kind != WatchEvidence::Kind::kNone) {
    last_ = evidence;
    last_ns_ = window_.back().timestamp_ns;
  }
  take(evidence);
}

/// From the calibration, or, where that leads nowhere, from what contradicted it last.
std::optional<WatchFit> CalibrationWatch::fit(std::span<const WatchFrame> frames) const {
  const Pose& calibrated = calibration_.hand_from_eye;
  auto fit = watch_fit(frames, calibrated, calibrated, fit_options_);
  if (!fit || explains(*fit) || !found_) return fit;
  const auto other = watch_fit(frames, *found_, calibrated, fit_options_);
  return other && explains(*other) ? other : fit;
}

/// The newest frames alone, where something may have changed within the window: the fewest that
/// tell enough. Where nothing near explains them, anything may have happened.
std::optional<WatchFit> CalibrationWatch::fit_newest() {
  const std::span<const WatchFrame> all(window_);
  std::optional<WatchFit> newest;
  for (const std::size_t count : {options_.middle_frames, options_.short_frames}) {
    if (count >= all.size()) continue;
    newest = fit(all.last(count));
    if (newest && contradicts(*newest)) return newest;
  }
  if (newest && !explains(*newest) && failed_looks_ % kSearchEvery == 1) {
    newest = watch_search(all.last(std::min(all.size(), options_.short_frames)),
                          calibration_.hand_from_eye, fit_options_);
  }
  return newest;
}

bool CalibrationWatch::contradicts(const WatchFit& fit) const {
  return judge(fit).kind == WatchEvidence::Kind::kContradicts;
}

WatchEvidence CalibrationWatch::judge(const WatchFit& fit) const {
  return weigh(fit, calibration_.hand_from_eye, calibration_.covariance, options_.evidence);
}

WatchEvidence CalibrationWatch::examine() {
  std::optional<WatchFit> found = fit(window_);
  const bool suspicious = found && (!explains(*found) || found->gain > kSuspiciousGain);
  if (suspicious && !contradicts(*found)) {
    const std::optional<WatchFit> newest = fit_newest();
    if (newest && (contradicts(*newest) || !explains(*found))) found = newest;
  }
  if (!found) return {};
  failed_looks_ = explains(*found) ? 0 : failed_looks_ + 1;
  WatchEvidence evidence = judge(*found);
  if (evidence.kind == WatchEvidence::Kind::kContradicts) {
    // What looks different each time is noise, or a scene that moves; it begins anew.
    if (found_ && rotation_angle_rad(found_->linear(), found->hand_from_eye.linear()) >
                      std::max(kSameTurn_rad, 0.3 * rad_from_deg(evidence.deviation_deg))) {
      contradictions_ = 0;
    }
    found_ = found->hand_from_eye;
  }
  return evidence;
}

void CalibrationWatch::take(const WatchEvidence& evidence) {
  switch (evidence.kind) {
    case WatchEvidence::Kind::kNone:
      return;
    case WatchEvidence::Kind::kContradicts:
      agreements_ = 0;
      broken_ |= ++contradictions_ >= options_.looks_to_break;
      return;
    case WatchEvidence::Kind::kAgrees:
      contradictions_ = 0;
      broken_ &= ++agreements_ < options_.looks_to_mend;
      return;
  }
}

WatchStatus CalibrationWatch::status(std::int64_t now_ns) const {
  WatchStatus status{.state = WatchState::kUnchecked};
  const bool ever = last_.kind != WatchEvidence::Kind::kNone;
  if (ever) {
    status.deviation_deg = last_.deviation_deg;
    status.sigma_deg = last_.sigma_deg;
    status.age_s = std::max(0.0, seconds(now_ns - last_ns_));
  }
  const std::string deviation = fmt::format("turned by {:.1f} deg", last_.deviation_deg);
  if (broken_) {
    status.state = WatchState::kBroken;
    status.text = fmt::format("the camera head has {}: calibrate again", deviation);
  } else if (contradictions_ >= options_.looks_to_doubt) {
    status.state = WatchState::kDoubtful;
    status.text = fmt::format("the camera head seems to have {}", deviation);
  } else if (ever && status.age_s <= options_.holds_for_s) {
    status.state = WatchState::kHolds;
  } else {
    status.text =
        ever ? fmt::format("not seen for {:.0f} s: too little motion, or too little to see",
                           status.age_s)
             : "not seen yet: too little motion, or too little to see";
  }
  return status;
}

}  // namespace handeye
