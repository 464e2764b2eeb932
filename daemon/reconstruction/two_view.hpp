// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include "daemon/geometry/pose.hpp"

namespace handeye {

/// The undistorted rays (x/z, y/z) of one feature in two views.
struct RayPair {
  Eigen::Vector2d first;
  Eigen::Vector2d second;
};

/// Median distance of the rays' coordinates; 0 for none.
double median_movement(const std::vector<RayPair>& pairs);

/// How well a rotation alone explains the movement between two views.
struct RotationFit {
  Eigen::Matrix3d second_from_first{Eigen::Matrix3d::Identity()};
  double inlier_ratio{0};  ///< share of the features within the threshold
  double residual_rad{0};  ///< median angle that it leaves
};

/// Robust rotation between the views (Kabsch on unit rays, reweighted).
RotationFit fit_rotation(const std::vector<RayPair>& pairs, double threshold_rad);

/// Sampson distance of a pair from the epipolar lines of a motion [normalised units].
double epipolar_distance(const Pose& second_from_first, const RayPair& pair);

/// A motion that the two views allow.
struct TwoViewMotion {
  Pose second_from_first{Pose::Identity()};  ///< translation of length 1
  double inlier_ratio{0};  ///< share of all features: near their epipolar line, in front of both
  double parallax_rad{0};  ///< median over the inliers, after derotation
};

/// Candidates of the motion, best supported first: from the essential matrix by five points in
/// RANSAC (Nister 2004) and from a homography, since in front of a plane two motions explain the
/// views and the first alone may be the wrong one. Which is right, more views must tell.
/// Deterministic: OpenCV seeds both RANSACs with a constant.
std::vector<TwoViewMotion> two_view_motions(const std::vector<RayPair>& pairs,
                                            double threshold_rad);

}  // namespace handeye
