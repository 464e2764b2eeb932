// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/residual_whitening.hpp"

#include <cmath>

namespace handeye {

ResidualWhitening::ResidualWhitening(const ResidualNoise::Variances& variances,
                                     double scale_of_noise, const PoseUnknowns& unknowns)
    : lever_arm_mm_(unknowns.eye_in_hand_mm) {
  const double rotation = variances.hand_rotation + variances.eye_rotation;
  rotation_weight_ = 1.0 / std::sqrt(rotation);
  hand_share_ = variances.hand_rotation / rotation;

  const double shrunk = std::exp(-2.0 * (unknowns.log_scale - scale_of_noise));
  const double eye = variances.eye_share * variances.translation * shrunk;
  const double v = (1.0 - variances.eye_share) * variances.translation + eye;
  const double dv_dscale = -2.0 * eye;
  const double k = hand_share_ * variances.eye_rotation;
  const double q = lever_arm_mm_.squaredNorm();

  // m = (v + k q)^(-1/2); g = (f - 1) / q with f = sqrt((v + k q) / v), free of the quotient by q.
  m_ = 1.0 / std::sqrt(v + k * q);
  const double f = std::sqrt(1.0 + k * q / v);
  g_ = k / v / (f + 1.0);
  const double dm = -0.5 * m_ * m_ * m_;  // by v + k q
  const double dg_df = -g_ / (f + 1.0);
  const double df_dq = 0.5 * k / v / f;
  const double df_dv = -0.5 * k * q / (v * v) / f;
  dm_dt_ = dm * k * 2.0 * lever_arm_mm_.transpose();
  dg_dt_ = dg_df * df_dq * 2.0 * lever_arm_mm_.transpose();
  dm_dscale_ = dm * dv_dscale;
  dg_dscale_ = (dg_df * df_dv - g_ / v) * dv_dscale;
}

Eigen::Vector3d ResidualWhitening::decorrelated(const Vector6d& residual) const {
  return residual.tail<3>() + hand_share_ * lever_arm_mm_.cross(residual.head<3>());
}

Vector6d ResidualWhitening::value(const Vector6d& residual) const {
  const Eigen::Vector3d h = decorrelated(residual);
  Vector6d whitened;
  whitened << rotation_weight_ * residual.head<3>(),
      m_ * (h + g_ * lever_arm_mm_.dot(h) * lever_arm_mm_);
  return whitened;
}

void ResidualWhitening::apply(PoseResidual& residual) const {
  const Eigen::Vector3d& t = lever_arm_mm_;
  const Eigen::Vector3d w = residual.value.head<3>();
  const Eigen::Vector3d h = decorrelated(residual.value);
  const double along = t.dot(h);
  const Eigen::Vector3d unscaled = h + g_ * along * t;

  auto rotation = residual.jacobian.topRows<3>();
  auto position = residual.jacobian.bottomRows<3>();
  position += hand_share_ * skew(t) * rotation;
  position.middleCols<3>(kEyeShift) -= hand_share_ * skew(w);
  const Eigen::Matrix3d root = m_ * (Eigen::Matrix3d::Identity() + g_ * t * t.transpose());
  position = (root * position).eval();
  position.middleCols<3>(kEyeShift) +=
      unscaled * dm_dt_ +
      m_ * (along * t * dg_dt_ + g_ * (along * Eigen::Matrix3d::Identity() + t * h.transpose()));
  position.col(kLogScale) += dm_dscale_ * unscaled + m_ * dg_dscale_ * along * t;
  rotation *= rotation_weight_;
  residual.value << rotation_weight_ * w, m_ * unscaled;
}

}  // namespace handeye
