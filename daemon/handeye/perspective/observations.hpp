// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "daemon/geometry/pose.hpp"

namespace handeye {

/// A point of the calibration object and where the camera saw it.
struct ObjectPoint {
  Eigen::Vector3d object_mm{Eigen::Vector3d::Zero()};
  Eigen::Vector2d pixel{Eigen::Vector2d::Zero()};  ///< distorted, as found in the image
};

/// What one position of the hand shows.
struct ObservedPosition {
  Pose hand1_from_hand{Pose::Identity()};  ///< A, mm
  std::vector<ObjectPoint> points;
};

/// Input of the one-step calibration (seed 2): 2-D/3-D correspondences per position, and the
/// hand's poses. The first position is hand1: its pose is the identity.
struct Observations {
  int width{0};                        ///< px
  int height{0};                       ///< px
  Eigen::Vector2d pixel_mm{1.0, 1.0};  ///< size of a pixel on the sensor
  std::vector<ObservedPosition> positions;

  std::size_t point_count() const;

  /// All points of all positions lie in one plane of the object.
  bool planar() const;
};

/// Why nothing can be calibrated from these observations.
struct PerspectiveRefusal {
  std::string reason;  ///< a word for scripts, as in the result JSON: "single_axis", ...
  std::string advice;  ///< one line: what is wrong and what to do
};

/// What the data lack before any solving: positions, usable numbers (finite, up to 1e9, rotations),
/// points, or rotation of the hand. Nothing: nothing is lacking.
std::optional<PerspectiveRefusal> lacking(const Observations& observations);

}  // namespace handeye
