// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/geometry/pose.hpp"
#include "drivers/simulator/random_stream.hpp"

namespace handeye::simulator {

/// How the endoscope is moved: two good ways and all the bad ones.
enum class MotionKind {
  kFree,         ///< circles the target by +-20 deg about all axes, shifted by +-15 mm along all
  kTranslation,  ///< shifts only
  kRotation,     ///< turns about the camera's centre only
  kSingleAxis,   ///< like kFree, but all rotations are about one direction
  kPivot,        ///< turns about one fixed point on the scope, as in a trocar
  kStatic,       ///< held still
  kWobble,       ///< held as still as a hand can: less than the tracker's noise
  kPivotSlide,   ///< like kPivot, and slides in and out through the fixed point: a good way again
  kRollOnly,     ///< turns about the optical axis only
};

/// The name on the command line: free, translation, rotation, single-axis, pivot, static, wobble,
/// pivot-slide, roll-only.
std::string_view motion_name(MotionKind kind);
std::optional<MotionKind> motion_from_name(std::string_view name);

struct MotionOptions {
  MotionKind kind{MotionKind::kFree};
  double view_distance_mm{80.0};  ///< from the target to the eye
  double rotation_deg{20.0};      ///< largest turn about each axis
  double shift_mm{15.0};          ///< largest shift along each axis
  double pivot_behind_eye_mm{100.0};
  double pivot_tilt_deg{12.0};  ///< pivots turn less across the scope: they sweep far more
  double wobble_deg{0.02};      ///< kWobble: largest turn about each axis
  double wobble_mm{0.04};       ///< kWobble: largest shift along each axis
};

/// A smooth, aperiodic wander between -1 and 1: a sine whose phase is itself swayed by slower,
/// incommensurate sines, so that it keeps reaching both ends but never repeats.
class Wander {
 public:
  explicit Wander(RandomStream& random);
  double at(double time_s) const;

 private:
  struct Sway {
    double amplitude_rad, angular_frequency, phase_rad;
  };
  double angular_frequency_;
  double phase_rad_;
  std::array<Sway, 3> sways_;
};

/// Where the eye is at any time; defined for all times and as smooth as sines. Drawn from the seed.
class Motion {
 public:
  /// `target`: the surface point looked at, in surface coordinates.
  Motion(std::uint64_t seed, Eigen::Vector3d target, const MotionOptions& options = {});

  /// Time 0 is the start of the simulation.
  Pose surface_from_eye(double time_s) const;

  /// kPivot: the fixed point, in eye coordinates (behind the eye, z < 0). kPivotSlide: in the mean.
  Eigen::Vector3d pivot_in_eye() const { return {0, 0, -options_.pivot_behind_eye_mm}; }

 private:
  Eigen::Vector3d turn(double time_s) const;   ///< rotation vector in the eye frame [rad]
  Eigen::Vector3d shift(double time_s) const;  ///< in surface coordinates [mm]
  double slide_mm(double time_s) const;        ///< along the scope, inwards

  MotionOptions options_;
  Eigen::Vector3d target_;
  Eigen::Vector3d single_axis_;  ///< in the eye frame
  std::vector<Wander> turns_;
  std::vector<Wander> shifts_;
};

}  // namespace handeye::simulator
