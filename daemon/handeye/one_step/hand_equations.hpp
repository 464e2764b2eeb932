// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "daemon/handeye/one_step/metric_noise.hpp"

namespace handeye {

/// Steps of the unknowns, or gradients by them, a column each.
struct MetricColumns {
  Eigen::MatrixXd of_unknowns;  ///< keyframes and common
  Eigen::MatrixXd by_sight;     ///< keyframes by sight (sight.hpp), (w, dC) like the keyframes
};

/// A frame's tracker residual, whitened, and how it changes with the unknowns that it knows of.
struct HandRow {
  std::size_t frame{0};  ///< position in MetricScene::frames
  double weight{1};      ///< of Huber's loss
  Vector6d residual;     ///< weighted by its root
  /// Of the frame's eye: a keyframe's own, or as keyframes by sight move it by their shares;
  /// likewise
  Matrix6d by_eye;
  Eigen::Matrix<double, 6, kLensInCommon> by_common;  ///< hand_from_eye and time; likewise

  /// What steps do to the residual; column of `steps`.
  Vector6d change(const MetricScene& scene, const MetricColumns& steps, Eigen::Index column) const;
  /// Adds J^T value.
  void add_gradient(const MetricScene& scene, const Vector6d& value, MetricColumns& sum,
                    Eigen::Index column) const;
};

/// Which frames' hands count and from which norm on less.
struct HandSelection {
  HandWeights weights;
  std::vector<bool> kept;  ///< one a frame of the scene; false: none, or an outlier
  double huber{0};
};

/// `eyes`: room_from_eye of the scene's frames at `state`.
std::vector<HandRow> hand_rows(const MetricScene& scene, const MetricState& state,
                               const std::vector<Pose>& eyes, const HandSelection& hands);
double hand_cost(const MetricScene& scene, const MetricState& state, const std::vector<Pose>& eyes,
                 const HandSelection& hands);

}  // namespace handeye
