// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/session/calibration_watch_evidence.hpp"
#include "daemon/session/calibration_watch_frame.hpp"
#include "daemon/sync/pose_buffer.hpp"
#include "daemon/tracking/feature_tracker.hpp"

namespace handeye {

/// The calibration that is watched.
struct WatchedCalibration {
  Pose hand_from_eye{Pose::Identity()};
  Matrix6d covariance{Matrix6d::Zero()};  ///< of (w [rad], dt [mm]), as in CalibrationResult
  double time_offset_s{0};
  CameraModel camera;  ///< with the lens that the calibration used or found
  WatchHandNoise hand_noise;
  double image_noise_px{0.5};  ///< of a feature, per axis
};

enum class WatchState {
  kOff,        ///< nothing is watched
  kUnchecked,  ///< too little motion, or too little to see
  kHolds,
  kDoubtful,  ///< contradicted, not yet for sure
  kBroken,    ///< contradicted, until it clearly agrees again or there is a new calibration
};

struct WatchStatus {
  WatchState state{WatchState::kOff};
  std::string text;         ///< one line for a person
  double deviation_deg{0};  ///< turn against the calibration, when last seen
  double sigma_deg{-1};     ///< of it; -1: never seen
  double age_s{-1};         ///< since it was last seen to hold, or not to; -1: never
};

struct WatchOptions {
  std::size_t window_frames{48};  ///< that are looked at together
  /// Of them the newest, where something may have changed within them.
  std::size_t middle_frames{32}, short_frames{20};
  std::int64_t keep_every_ns{70'000'000};  ///< at most: 3.4 s of motion and more
  double keep_turn_deg{0.6};               ///< of the hand since the last frame that was kept, or
  double keep_shift_mm{1.0};               ///< this; well above a tracker's noise
  std::int64_t window_age_ns{60'000'000'000};  ///< older frames are forgotten
  int look_every{12};                          ///< frames kept from one look to the next
  int look_again_after{6};                     ///< likewise after a contradiction
  double holds_for_s{30};                      ///< that an agreement is believed for
  int looks_to_doubt{2};                       ///< contradictions in a row
  int looks_to_break{3};                       ///< likewise
  int looks_to_mend{3};  ///< agreements in a row after which a broken one holds again
  double time_offset_sigma_s{0.002};
  WatchEvidenceOptions evidence;
};

/// Watches from live images whether a calibration still holds: a camera head may be turned or
/// mounted anew. Keeps frames in which the hand has moved, and now and then fits hand_from_eye to
/// the last of them alone (watch_fit), to be compared with the calibration's. Knows no thread and
/// no clock but the stamps it is given; bounded memory; deterministic. One thread.
class CalibrationWatch {
 public:
  explicit CalibrationWatch(WatchedCalibration calibration, const WatchOptions& options = {});

  /// Samples of the calibrated hand, in order of time.
  void add_hand(const HandSample& sample);

  /// What was tracked in an image, in order of time; feature_ids go on from frame to frame. Now and
  /// then looks: some ten milliseconds, some hundred where what is seen fits nothing.
  void add_frame(const TrackedFrame& frame);

  /// Features are numbered anew from here on: there was a pause of the tracking.
  void forget_features() { window_.clear(); }

  /// `now_ns`: by the clock of the frames' stamps.
  WatchStatus status(std::int64_t now_ns) const;

  int looks() const { return looks_; }

 private:
  void take_pending();
  bool keeps(const TrackedFrame& frame, const Pose& room_from_hand) const;
  void keep(const TrackedFrame& frame, const HandLookup& hand);
  void look();
  bool is_look_due() const;
  std::optional<WatchFit> fit(std::span<const WatchFrame> frames) const;
  std::optional<WatchFit> fit_newest();
  bool contradicts(const WatchFit& fit) const;
  WatchEvidence judge(const WatchFit& fit) const;
  WatchEvidence examine();
  void take(const WatchEvidence& evidence);

  WatchedCalibration calibration_;
  WatchOptions options_;
  WatchFitOptions fit_options_;
  PoseBuffer hand_;
  std::deque<TrackedFrame> pending_;  ///< the hand's samples after them have not come yet
  std::vector<WatchFrame> window_;
  int since_look_{0};
  int looks_{0};
  bool contradicted_{false};  ///< by the last look
  int failed_looks_{0};       ///< in a row: nothing explained what was seen
  int contradictions_{0};
  int agreements_{0};
  bool broken_{false};
  WatchEvidence last_;  ///< the last that was conclusive
  std::int64_t last_ns_{0};
  std::optional<Pose> found_;  ///< hand_from_eye by the last contradiction
};

}  // namespace handeye
