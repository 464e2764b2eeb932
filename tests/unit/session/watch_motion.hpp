// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <random>
#include <vector>

#include "daemon/geometry/pose.hpp"

namespace handeye::test {

/// How a scope is moved for some seconds.
enum class MotionKind {
  kFree,       ///< up to 18 deg and 15 mm an axis
  kPause,      ///< held still
  kSmall,      ///< up to 2 deg and 2 mm
  kTurning,    ///< about the camera's centre
  kPivot,      ///< about a point 120 mm behind the camera, without sliding
  kSliding,    ///< in and out, hardly a turn
  kOneAxis,    ///< turns about one axis, with shifts
  kTrembling,  ///< quick, up to 0.7 deg and 0.5 mm
};
inline constexpr std::array<MotionKind, 8> kEveryMotion{
    MotionKind::kFree,  MotionKind::kPause,   MotionKind::kSmall,   MotionKind::kTurning,
    MotionKind::kPivot, MotionKind::kSliding, MotionKind::kOneAxis, MotionKind::kTrembling};

/// A smooth random motion of the camera about a view from above, kinds taking turns every 4 to 15
/// s.
class WatchMotion {
 public:
  WatchMotion(std::vector<MotionKind> kinds, unsigned seed);

  /// Goes on to that time [s], which must not fall.
  void advance(double time_s);

  Pose room_from_eye() const;
  double speed_deg_s() const { return deg_from_rad(turn_speed_.norm()); }
  double speed_mm_s() const { return speed_mm_s_; }

 private:
  void begin_kind();
  void choose_target();
  void move(double step_s);
  double uniform(double low, double high);
  Eigen::Vector3d within(double size);

  std::vector<MotionKind> kinds_;
  std::mt19937 random_;
  MotionKind kind_{MotionKind::kFree};
  double time_s_{0};
  double kind_until_s_{0};
  double target_until_s_{0};
  double stiffness_{3};  ///< of the hand that follows its aim [rad/s]
  Eigen::Vector3d turn_{Eigen::Vector3d::Zero()}, turn_speed_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d place_{Eigen::Vector3d::Zero()}, place_speed_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d aim_turn_{Eigen::Vector3d::Zero()}, aim_place_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d pivot_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d axis_{Eigen::Vector3d::UnitX()};
  double speed_mm_s_{0};
};

}  // namespace handeye::test
