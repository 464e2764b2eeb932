// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/one_step/metric_noise.hpp"

#include <Eigen/Cholesky>

#include "daemon/handeye/one_step/hand_term.hpp"

namespace handeye {
namespace {

double square(double x) {
  return x * x;
}

}  // namespace

double interpolated_variance(const HandAtFrame& hand) {
  double variance = 0;
  for (const double share : hand.shares) variance += square(share);
  return variance;
}

Matrix6d sample_covariance(const HandAtFrame& hand, const MetricNoise& noise, bool measured) {
  if (measured && hand.sample_covariance) return *hand.sample_covariance;
  Vector6d variances;
  variances << Eigen::Vector3d::Constant(square(noise.hand_rotation_rad)),
      Eigen::Vector3d::Constant(square(noise.hand_translation_mm));
  return variances.asDiagonal();
}

Matrix6d eye_noise_at_hand(const MetricFrame& frame, const Pose& room_from_eye,
                           const MetricState& state, double scale) {
  const Eigen::Matrix3d turned =
      room_from_eye.linear() * frame.room_from_eye_start.linear().transpose();
  Matrix6d moved = Matrix6d::Zero();
  moved.topLeftCorner<3, 3>() = turned;
  moved.bottomRightCorner<3, 3>() = scale * turned;
  const Matrix6d by_eye = hand_derivatives(*frame.hand, room_from_eye, state).by_eye * moved;
  return by_eye * frame.unit_covariance * by_eye.transpose();
}

HandWeights hand_weights(const MetricScene& scene, const std::vector<Pose>& eyes,
                         const MetricState& state, const MetricNoise& noise, bool measured) {
  HandWeights weights;
  const std::vector<double> scales = scales_since_start(scene, state);
  weights.whitenings.assign(scene.frames.size(), Matrix6d::Zero());
  for (std::size_t k = 0; k < scene.frames.size(); ++k) {
    const MetricFrame& frame = scene.frames[k];
    if (!frame.hand) continue;
    Matrix6d covariance =
        interpolated_variance(*frame.hand) * sample_covariance(*frame.hand, noise, measured);
    if (!frame.keyframe) {
      covariance +=
          square(noise.image_px) * eye_noise_at_hand(frame, eyes[k], state, scales[frame.part]);
    }
    const Eigen::LLT<Matrix6d> root(covariance);
    // A covariance that is none says nothing about its frame.
    if (root.info() != Eigen::Success) continue;
    weights.whitenings[k] = root.matrixL().solve(Matrix6d::Identity());
  }
  return weights;
}

}  // namespace handeye
