// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <span>
#include <vector>

#include "daemon/session/calibration_watch.hpp"
#include "tests/unit/session/watch_motion.hpp"

namespace handeye::test {

/// A calibrated scope in use, as tracks: what a watch is given. Camera stamps are 20 ms ahead of
/// the tracker's.
struct WatchSceneOptions {
  unsigned seed{1};
  double rate_hz{12.5};
  double tracker_hz{60};
  double noise_px{0.4};   ///< white, per axis, of every sight
  double drift_px{0.02};  ///< a feature walks off, per axis and frame
  double hand_rotation_deg{0.06};
  double hand_translation_mm{0.15};
  /// The same as a slow error, by which the tracker is wrong from place to place; per axis.
  double hand_slow_deg{0};
  double hand_slow_mm{0};
  int max_features{80};
  double death_rate{0.01};  ///< features lost, of those in view, per frame
  double sliding{0.03};     ///< share of the features that slide off on their own
  bool disturbed{true};     ///< occlusions of the hand, covered lens, changes of scene
  std::vector<MotionKind> motions{kEveryMotion.begin(), kEveryMotion.end()};
  /// The head, from this time on [s]; < 0: it stays.
  double turned_at_s{-1};
  Eigen::Vector3d turn_deg{Eigen::Vector3d::Zero()};  ///< rotation vector in the eye frame
  Eigen::Vector3d shift_mm{Eigen::Vector3d::Zero()};  ///< of the camera, in the eye frame
  double turning_s{0.3};                              ///< that it takes
  /// Of the calibration in use, per axis: its error is drawn from it.
  double calibration_sigma_deg{0.04};
  double calibration_sigma_mm{0.3};
};

/// Where a scene goes.
struct WatchSink {
  std::function<void(const HandSample&)> add_hand;
  std::function<void(const TrackedFrame&)> add_frame;
};

class WatchScene {
 public:
  explicit WatchScene(const WatchSceneOptions& options);

  const WatchedCalibration& calibration() const { return calibration_; }

  /// The next frame, and after it the samples of the hand up to some ms after it, into the watch.
  /// Returns the frame's stamp.
  std::int64_t next(CalibrationWatch& watch);
  std::int64_t next(const WatchSink& sink);

  double time_s() const { return time_s_; }

  // What only an onlooker knows.
  Pose room_from_hand() const { return motion_.room_from_eye() * true_hand_from_eye_.inverse(); }
  Pose hand_from_eye() const;
  const TrackedFrame& frame() const { return frame_; }  ///< the last one
  bool hand_hidden() const { return time_s_ < hidden_until_s_; }
  /// Of the features in the last frame, whether it slides off on its own.
  bool slides(std::int64_t feature_id) const;
  /// Time so far, since the head was turned, in which the hand moved (5 deg/s or 5 mm/s) and was
  /// seen, with the lens free.
  double moved_since_turn_s() const { return moved_since_turn_s_; }

 private:
  struct Point {
    Eigen::Vector3d room{Eigen::Vector3d::Zero()};
    std::int64_t feature_id{-1};
    bool sliding{false};
    Eigen::Vector2d off_px{Eigen::Vector2d::Zero()};
    Eigen::Vector2d step_px{Eigen::Vector2d::Zero()};
  };
  void build_scene();
  void disturb();
  HandSample sample_hand(double time_s, const Pose& room_from_hand);
  void look(const Pose& room_from_eye);

  WatchSceneOptions options_;
  std::mt19937 random_;
  std::normal_distribution<double> normal_{0.0, 1.0};
  std::uniform_real_distribution<double> uniform_{0.0, 1.0};
  WatchMotion motion_;
  Pose true_hand_from_eye_{Pose::Identity()};
  WatchedCalibration calibration_;
  std::vector<Point> points_;
  TrackedFrame frame_;
  std::vector<HandSample> samples_;
  std::int64_t next_feature_{0};
  double time_s_{0};
  double next_sample_s_{0};
  double hidden_until_s_{0};
  double covered_until_s_{0};
  double moved_since_turn_s_{0};
  Vector6d slow_phase_{Vector6d::Zero()};
};

}  // namespace handeye::test
