// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "daemon/geometry/camera_model.hpp"
#include "daemon/geometry/pose.hpp"
#include "daemon/sync/pose_buffer.hpp"
#include "daemon/tracking/feature_tracker.hpp"

namespace handeye {

/// A feature in one frame.
struct WatchRay {
  std::int64_t feature_id{0};
  Eigen::Vector2d ray{Eigen::Vector2d::Zero()};  ///< x/z, y/z in the eye frame, undistorted
};

/// What was seen at one instant, and where the hand was by the tracker.
struct WatchFrame {
  std::int64_t timestamp_ns{0};  ///< camera stamp
  Pose room_from_hand{Pose::Identity()};
  Eigen::Vector3d angular_velocity{Eigen::Vector3d::Zero()};  ///< in the room [rad/s]
  Eigen::Vector3d velocity{Eigen::Vector3d::Zero()};  ///< of the hand's origin, in the room [mm/s]
  /// Of (w [rad], dt [mm]) of room_from_hand, R = Exp(w) R, t = t + dt.
  Matrix6d hand_covariance{Matrix6d::Identity()};
  std::vector<WatchRay> rays;  ///< ordered by feature_id
};

/// Noise of a sample of the hand, per axis, where the tracker does not say its own.
struct WatchHandNoise {
  double rotation_rad{0.001};
  double translation_mm{0.15};
};

/// `hand`: LookupStatus::kOk, at the frame's time by the tracker's stamps.
WatchFrame make_watch_frame(const CameraModel& camera, const TrackedFrame& frame,
                            const HandLookup& hand, const WatchHandNoise& noise);

/// A feature over several frames as a point: at `bearing` / inverse depth in the eye frame of an
/// instant (Civera, Davison, Montiel, Inverse Depth Parametrization, 2008).
/// Without parallax the inverse depth stays open, which disturbs nothing else.
struct WatchTrack {
  struct Sight {
    int frame{0};
    Eigen::Vector2d ray{Eigen::Vector2d::Zero()};
    double trust{1};  ///< in it: its weight is so much smaller
  };
  int anchor{0};  ///< the frame whose eye it was
  Pose room_from_anchor{Pose::Identity()};
  Eigen::Vector3d point{Eigen::Vector3d::Zero()};  ///< x/z, y/z, 1/z [1/mm] in the anchor's frame
  std::vector<Sight> sights;                       ///< ordered by frame
};

/// More sights tell hardly more, and take their time.
inline constexpr std::size_t kMostWatchSights = 3500;

/// The features that at least `min_sights` of the frames show; of many those that were seen
/// longest.
std::vector<WatchTrack> watch_tracks(std::span<const WatchFrame> frames, std::size_t min_sights,
                                     std::size_t most_sights = kMostWatchSights);

/// Lays each point where the cameras, as given, see it best. `room_from_eye`: frame by frame.
void place_points(std::span<const Pose> room_from_eye, std::vector<WatchTrack>& tracks);

}  // namespace handeye
