// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "daemon/geometry/pose.hpp"

namespace handeye {

/// M = K * eye_from_object: maps an object point (X, Y, Z, 1) [mm] to homogeneous coordinates of
/// its undistorted image [mm on the sensor, from the image centre]. Normalised: the third row of
/// its 3x3 part has norm 1, so that the third coordinate is the depth [mm], positive in front.
using PerspectiveMatrix = Eigen::Matrix<double, 3, 4>;

/// What DLT needs: so many points, not all in one plane.
inline constexpr std::size_t kMinPointsForMatrix = 6;

/// The same matrix, scaled so that the third row of its 3x3 part has norm 1 and `in_front` (an
/// object point) positive depth. Nothing when that row is zero.
std::optional<PerspectiveMatrix> normalised(const PerspectiveMatrix& matrix,
                                            const Eigen::Vector3d& in_front);

/// Direct linear transformation from points and their undistorted images (equal lengths). Nothing
/// when the points do not determine a matrix: too few, all in one plane, or not finite.
std::optional<PerspectiveMatrix> perspective_matrix(std::span<const Eigen::Vector3d> points_mm,
                                                    std::span<const Eigen::Vector2d> images_mm);

/// A perspective matrix taken apart.
struct Decomposition {
  Eigen::Matrix3d intrinsics;  ///< K, upper triangular, positive diagonal, K(2, 2) = 1 [mm]
  Pose eye_from_object;
};

/// Nothing for a mirrored image (no rotation explains it) and for singular matrices.
std::optional<Decomposition> decompose(const PerspectiveMatrix& matrix);

/// K * eye_from_object.
PerspectiveMatrix compose(const Eigen::Matrix3d& intrinsics, const Pose& eye_from_object);

/// Whether all points lie in one plane, within a thousandth of their extent.
bool coplanar(std::span<const Eigen::Vector3d> points_mm);

}  // namespace handeye
