// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/geometry/pose.hpp"

/// What one DTrack datagram says, line type by line type. A line type that is absent from the
/// datagram leaves its list empty: nothing is ever carried over from an earlier datagram.
/// Lengths in mm, angles in rad (converted from the wire's degrees), ids as on the wire.
namespace handeye::dtrack {

/// Lines 6d and 6di: a standard or hybrid body.
struct Body {
  std::int32_t id{0};
  bool tracked{false};              ///< false: `room_from_body` is the identity, do not use
  double quality{0};                ///< 6d: unused by the tracker (1.0)
  std::int32_t inertial_state{-1};  ///< 6di: 0 none, 1 inertial, 2 optical, 3 both; -1: from 6d
  double inertial_drift_rad{0};     ///< 6di: estimated drift of the inertial rotation
  Pose room_from_body{Pose::Identity()};
};

/// Line 6dcov: covariance of a body's pose.
struct BodyCovariance {
  std::int32_t id{0};
  Eigen::Vector3d reference_point_mm{Eigen::Vector3d::Zero()};  ///< in the room
  /// Order x y z [mm] and the three Euler angles [rad].
  Matrix6d covariance{Matrix6d::Zero()};
};

/// Lines 6df2 and 6df: a Flystick. Buttons stay valid while it is not tracked.
struct Flystick {
  std::int32_t id{0};
  bool tracked{false};
  double quality{0};
  Pose room_from_body{Pose::Identity()};
  std::vector<bool> buttons;      ///< button 0 is the trigger
  std::vector<double> joysticks;  ///< -1..1
};

/// Lines 6dmt2 and 6dmt: a measurement tool with a spherical tip.
struct MeasurementTool {
  std::int32_t id{0};
  bool tracked{false};
  double quality{0};
  Pose room_from_tool{Pose::Identity()};
  double tip_radius_mm{0};
  std::vector<bool> buttons;  ///< button 0: a point is being measured
  Eigen::Matrix3d tip_covariance_mm2{Eigen::Matrix3d::Zero()};
};

/// Line 6dmtr: reference body of a measurement tool; only tracked ones are sent.
struct ToolReference {
  std::int32_t id{0};
  double quality{0};
  Pose room_from_reference{Pose::Identity()};
};

/// Line 3d: a single marker.
struct Marker {
  std::int32_t id{0};  ///< from 1; a lost marker returns with a new id
  double quality{0};
  Eigen::Vector3d position_mm{Eigen::Vector3d::Zero()};
};

struct Finger {
  Pose hand_from_fingertip{Pose::Identity()};
  double tip_radius_mm{0};
  std::array<double, 3> phalanx_length_mm{};  ///< outer to inner
  std::array<double, 2> joint_angle_rad{};    ///< outer-middle, middle-inner
};

/// Line gl: a Fingertracking hand; only tracked ones are sent.
struct FingertrackingHand {
  std::int32_t id{0};
  double quality{0};
  bool right{false};
  Pose room_from_hand_back{Pose::Identity()};
  std::vector<Finger> fingers;  ///< thumb first
};

struct Joint {
  std::int32_t id{0};
  bool tracked{false};
  double quality{0};
  Pose room_from_joint{Pose::Identity()};
  std::array<double, 3> relative_angle_rad{};  ///< deprecated by the vendor
};

/// Line 6dj: a human model.
struct HumanModel {
  std::int32_t id{0};
  std::vector<Joint> joints;
};

struct CameraStatus {
  std::int32_t id{0};
  std::int32_t reflections{0};
  std::int32_t reflections_used{0};
  std::int32_t max_intensity{0};  ///< 0..10
};

/// Line st: status of the system.
struct SystemStatus {
  std::int32_t cameras{0}, bodies{0}, markers{0};
  /// Counted since the controller booted.
  std::int32_t camera_errors{0}, camera_warnings{0}, other_errors{0}, other_warnings{0}, infos{0};
  std::vector<CameraStatus> camera_status;
};

/// Line ts2: measurement time by the controller's clock, and its latency up to sending.
struct UnixTime {
  std::uint32_t seconds{0};
  std::uint32_t microseconds{0};  ///< 0..999999
  std::uint32_t latency_us{0};
};

/// A parsed datagram. Reuse one object: its lists keep their memory.
struct Frame {
  std::uint32_t number{0};               ///< fr
  std::optional<double> seconds_of_day;  ///< ts: since 00:00 UTC, [0, 86400), at the IR flash
  std::optional<UnixTime> unix_time;     ///< ts2
  std::optional<std::int32_t>
      calibrated_bodies;  ///< 6dcal, less old-format Flysticks and tools, >= 0
  std::optional<std::int32_t> calibrated_hands;  ///< glcal
  std::vector<Body> bodies;                      ///< 6d and 6di; each id once, 6d first
  std::vector<BodyCovariance> covariances;
  std::vector<Flystick> flysticks;
  std::vector<MeasurementTool> tools;
  std::vector<ToolReference> tool_references;
  std::vector<Marker> markers;
  std::vector<FingertrackingHand> hands;
  std::vector<HumanModel> humans;
  std::optional<SystemStatus> system_status;

  /// The body with this id, or null.
  const Body* find_body(std::int32_t id) const;
};

}  // namespace handeye::dtrack
