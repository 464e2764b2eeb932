// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/calibration_watch_descent.hpp"

#include <algorithm>
#include <limits>

namespace handeye {
namespace {

constexpr double kFirstDamping = 1e-5;
constexpr double kLeastDamping = 1e-9;
constexpr double kMostDamping = 1e3;
/// A step that is damped more promises little wherever it is taken from.
constexpr double kHardlyDamped = 1e-2;
/// Expected fall of the cost by another step, of which 0.5 is one standard deviation.
constexpr double kConverged = 0.05;
/// Where even damped steps fall no more - points stand at an end of their range there - while
/// hardly damped ones promise less than this, is the minimum.
constexpr double kStanding = 0.5;
constexpr double kStandingDamping = 0.1;
/// A fall of the cost from which on the minimum is near.
constexpr double kNear = 1.0;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

WatchDescent watch_descend(std::span<const WatchFrame> frames, const WatchWeights& weights,
                           int most_iterations, WatchUnknowns& at) {
  settle_points(weights, at);
  double cost = watch_cost(frames, at, weights);
  double damping = kFirstDamping;
  double promised = kInfinity;
  WatchCurvature curvature = WatchCurvature::kGauss;
  bool may_be_newton = weights.robust_image <= 0;
  WatchDescent descent;
  while (descent.iterations < most_iterations && damping < kMostDamping && !descent.converged) {
    ++descent.iterations;
    WatchUnknowns next = at;
    const auto expected =
        WatchEquations(frames, at, weights, damping, curvature).step(frames, next);
    if (expected) settle_points(weights, next);
    const double next_cost = expected ? watch_cost(frames, next, weights) : kInfinity;
    const bool hardly_damped = damping < kHardlyDamped;
    if (expected && hardly_damped) promised = *expected;
    descent.converged = expected && hardly_damped && *expected < kConverged;
    if (next_cost < cost) {
      const bool near = may_be_newton && cost - next_cost < kNear;
      curvature = near ? WatchCurvature::kNewton : WatchCurvature::kGauss;
      at = std::move(next);
      cost = next_cost;
      damping = std::max(kLeastDamping, 0.1 * damping);
    } else if (curvature == WatchCurvature::kNewton && !descent.converged) {
      curvature = WatchCurvature::kGauss;
      may_be_newton = false;
    } else {
      damping = std::max(damping, kFirstDamping) * 10.0;
    }
    const bool standing = damping >= kStandingDamping && promised < kStanding;
    descent.converged |= standing && weights.robust_image <= 0;
  }
  return descent;
}

}  // namespace handeye
