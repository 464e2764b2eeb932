// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/handeye/types.hpp"

namespace handeye {

/// How hand and eye noise appear in one pose's residual (ours, docs/math.md section 4): rotation
/// [rad] and the position of the camera [mm], camera against tracker, both in the hand frame. To
/// first order the hand's rotation noise n turns it by -n and, at the end of the lever arm t =
/// translation of hand_from_eye, moves it by [t]x n; the other noises are isotropic in either
/// frame. So one 6x6 covariance serves all poses: noise of the latent poses is marginalised, not
/// estimated.
class ResidualNoise {
 public:
  /// Variances per axis; the translations of hand and eye cannot be told apart.
  struct Variances {
    double hand_rotation{0};
    double eye_rotation{0};
    double translation{0};
    double eye_share{0.5};  ///< of `translation`: assumed, never estimated
  };

  explicit ResidualNoise(const Eigen::Vector3d& lever_arm_mm) : lever_arm_mm_(lever_arm_mm) {}

  Matrix6d covariance(const Variances& variances) const;

  /// W with W cov W^T = 1.
  Matrix6d whitening(const Variances& variances) const;

  /// Maximum likelihood of the variances from the mean of r r^T, by Fisher scoring from `start`.
  Variances estimate(const Matrix6d& mean_square, const Variances& start) const;

 private:
  Eigen::Vector3d lever_arm_mm_;
};

ResidualNoise::Variances variances_of(const PoseNoise& noise);

/// The inverse.
PoseNoise noise_of(const ResidualNoise::Variances& variances);

}  // namespace handeye
