// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace handeye {

/// Camera motion and shape of P features in F frames as an affine camera sees them. Frame f has the
/// rows 2f and 2f+1; both factors are known up to a common 3x3 matrix.
struct AffineFactorisation {
  Eigen::VectorXd centroid;  ///< 2F: where the centroid of the features is seen, (x_f, y_f)
  Eigen::MatrixXd motion;    ///< 2F x 3: M^
  Eigen::Matrix3Xd shape;    ///< 3 x P: S^, about the centroid
  Eigen::Vector4d sigma;     ///< four largest singular values of the registered measurements
};

/// Rank-3 factorisation of the registered measurement matrix (Tomasi & Kanade 1992; Poelman &
/// Kanade 1997, PAMI 19(3); docs/math.md eqs F1-F3).
/// `rays`: 2F x P, rows x/z and y/z of the undistorted rays of each frame; all features are seen in
/// all frames. F >= 2, P >= 4.
AffineFactorisation factorise(const Eigen::MatrixXd& rays);

}  // namespace handeye
