// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/geometry/pose.hpp"
#include "daemon/sync/pose_buffer.hpp"
#include "daemon/tracking/feature_tracker.hpp"

/// A calibration's two streams with known truth, and no images: features as a tracker of features
/// hands them on, and the hand as a tracker of bodies does.
namespace handeye::tracked {

inline constexpr double kFrameRate_hz = 25;
inline constexpr double kTrackerRate_hz = 60;
inline constexpr double kTimeOffset_s = 0.023;  ///< camera stamp minus tracker stamp
inline constexpr std::int64_t kStart_ns = 1'000'000'000'000;
inline const CameraModel kCamera{640, 480, 600, 600, 320, 240, {-0.1, 0.01, 0, 0, 0}};

Pose true_hand_from_eye();

/// room_from_eye at a time [s].
using EyeMotion = std::function<Pose(double)>;

/// 80 mm above the scene: turns about three axes, shifts along three, not periodically.
Pose free_motion(double time_s);
/// The same place; turns about the camera's x only, about the middle of the scene.
Pose one_axis_motion(double time_s);

/// A bumpy surface of 120 x 120 mm. Noise by the seed: 0.2 px; 0.06 deg and 0.15 mm per axis.
class TrackedScene {
 public:
  explicit TrackedScene(EyeMotion room_from_eye = free_motion, int points = 500, unsigned seed = 7);

  /// In order of `index`: the noise is drawn as they come.
  TrackedFrame frame(std::int64_t index);
  HandSample hand(std::int64_t index);

 private:
  EyeMotion room_from_eye_;
  std::vector<Eigen::Vector3d> points_room_;
  std::mt19937 random_;
};

}  // namespace handeye::tracked
