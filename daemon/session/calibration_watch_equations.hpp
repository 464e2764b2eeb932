// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "daemon/session/calibration_watch_points.hpp"

namespace handeye {

/// Which second derivatives the equations have.
enum class WatchCurvature {
  kGauss,   ///< of the residuals none: always downhill
  kNewton,  ///< also a residual's by depth and the eye's shift, which are one product: a minimum is
            ///< reached in a few steps, far from it they may lead uphill
};

/// Normal equations with the points eliminated. Of frame k the six unknowns from 6 k
/// are how much farther its eye goes from where hand and common unknowns put it
/// (WatchHandResidual), the common ones are last: together with hand_from_eye all eyes go, along
/// their true arcs, so that neither damping nor a lever of some hundred mm makes the steps short.
class WatchEquations {
 public:
  WatchEquations(std::span<const WatchFrame> frames, const WatchUnknowns& at,
                 const WatchWeights& weights, double damping,
                 WatchCurvature curvature = WatchCurvature::kGauss);

  /// Moves the eyes and what they share by the step; the points go with the eye that they are
  /// anchored in. Returns by how much the cost should fall; nothing where the equations are not
  /// positive definite.
  std::optional<double> step(std::span<const WatchFrame> frames, WatchUnknowns& unknowns) const;

  const Eigen::MatrixXd& matrix() const { return matrix_; }  ///< lower half

 private:
  void add_track(const WatchTrack& track, const WatchUnknowns& at, const WatchWeights& weights,
                 WatchCurvature curvature);
  void add_hands(std::span<const WatchFrame> frames, const WatchUnknowns& at);
  void add_holds(const WatchUnknowns& at, const WatchWeights& weights);

  Eigen::MatrixXd matrix_;
  Eigen::VectorXd right_;
};

/// Robust cost of images and hand together, in units of half a squared standard deviation.
double watch_cost(std::span<const WatchFrame> frames, const WatchUnknowns& at,
                  const WatchWeights& weights);

}  // namespace handeye
