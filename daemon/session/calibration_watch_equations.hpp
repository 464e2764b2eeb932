// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "daemon/session/calibration_watch_unknowns.hpp"

namespace handeye {

// What is assumed of the depth of a scene, in 1/mm: hardly anything, only so that none is at
// infinity or in the lens.
inline constexpr double kUsualInverseDepth = 0.01;
inline constexpr double kInverseDepthSigma = 0.03;
inline constexpr double kLeastInverseDepth = 2e-4;
inline constexpr double kLargestInverseDepth = 0.3;
/// Beside residuals on the image plane at focal length 1, with an error of a thousandth.
inline constexpr double kInverseDepthWeight = 1e-6 / (kInverseDepthSigma * kInverseDepthSigma);

/// Standard deviations that residuals are weighed with.
struct WatchWeights {
  double image{0.001};          ///< of a ray, per axis, at focal length 1
  double robust_image{0.004};   ///< where the loss bends (Cauchy), likewise
  double time_offset_s{0.002};  ///< of the correction before the data
  // What the motion does not tell stays where it started; what it tells is not touched.
  double hold_rotation_rad{0.3};
  double hold_translation_mm{30.0};
};

/// Gauss-Newton's normal equations with the points eliminated. Of frame k the six unknowns from 6 k
/// are how much farther its eye goes from where hand and common unknowns put it
/// (WatchHandResidual), the common ones are last: together with hand_from_eye all eyes go, along
/// their true arcs, so that neither damping nor a lever of some hundred mm makes the steps short.
class WatchEquations {
 public:
  WatchEquations(std::span<const WatchFrame> frames, const WatchUnknowns& at,
                 const WatchWeights& weights, double damping);

  /// Moves the eyes and what they share by the step; the points go with the eye that they are
  /// anchored in. Returns by how much the cost should fall; nothing where the equations are not
  /// positive definite.
  std::optional<double> step(std::span<const WatchFrame> frames, WatchUnknowns& unknowns) const;

  const Eigen::MatrixXd& matrix() const { return matrix_; }  ///< lower half

 private:
  void add_track(const WatchTrack& track, const WatchUnknowns& at, const WatchWeights& weights);
  void add_hands(std::span<const WatchFrame> frames, const WatchUnknowns& at);
  void add_holds(const WatchUnknowns& at, const WatchWeights& weights);

  Eigen::MatrixXd matrix_;
  Eigen::VectorXd right_;
};

/// Adjusts the points alone to the eyes as they are. The elimination is then exact also for a long
/// step: together with hand_from_eye the whole scene turns, which points in the room follow badly
/// to first order.
void settle_points(const WatchWeights& weights, WatchUnknowns& unknowns);

/// A point's ray in an eye. Nothing: not before it.
std::optional<Eigen::Vector2d> watch_ray(const WatchTrack& track, const Pose& room_from_eye);

/// Robust cost of images and hand together, in units of half a squared standard deviation.
double watch_cost(std::span<const WatchFrame> frames, const WatchUnknowns& at,
                  const WatchWeights& weights);

}  // namespace handeye
