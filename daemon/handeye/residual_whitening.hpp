// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/handeye/noise_model.hpp"
#include "daemon/handeye/pose_residual.hpp"

namespace handeye {

/// ResidualNoise as a function of the unknowns that it depends on: the lever arm, and the scale,
/// by which the eye's noise shrinks with its path. Both sides of the equation carry noise; weights
/// that stayed constant while the scale changed would let the answer drift to where the eye's path,
/// noise and all, is scaled away (docs/math.md sections 2 and 10: errors in both variables, a fixed
/// point). With these the sum of squares is the likelihood of the latent poses eliminated (Deming's
/// regression), and so are its derivatives.
class ResidualWhitening {
 public:
  /// `scale_of_noise`: the log scale at which the eye's translation noise is what `variances` says.
  ResidualWhitening(const ResidualNoise::Variances& variances, double scale_of_noise,
                    const PoseUnknowns& unknowns);

  /// Unit covariance; by a root of its own: ResidualNoise::whitening gives the same norms.
  Vector6d value(const Vector6d& residual) const;
  void apply(PoseResidual& residual) const;

 private:
  /// Position and what rotation says about the hand's share in it.
  Eigen::Vector3d decorrelated(const Vector6d& residual) const;

  Eigen::Vector3d lever_arm_mm_;
  double rotation_weight_;  ///< 1 / sigma
  double hand_share_;       ///< of the rotation's variance
  // The position's covariance, rotation given, is v 1 + k ([t]x)(-[t]x); its inverse root
  // m (1 + g t t^T).
  double m_, g_;
  Eigen::RowVector3d dm_dt_, dg_dt_;
  double dm_dscale_, dg_dscale_;
};

}  // namespace handeye
