// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/calibration_watch_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

namespace handeye {
namespace {

/// Where the loss bends, in standard deviations of the image noise: first wide, for a start may be
/// far off, then as outliers deserve.
constexpr double kWideBend = 40.0;
constexpr double kBend = 4.0;
/// Features are off for as long as they live: measured, the rotation's variance is 1.6 times what
/// independent errors make it.
constexpr double kCorrelation = 2.0;
constexpr double kConverged = 0.02;  ///< fall of the cost, of which 0.5 is one standard deviation
/// What the motion does not tell stays about where it started.
constexpr double kFree_rad = 0.3;
constexpr double kFree_mm = 30.0;
/// Beyond, frames do not explain each other: something moved that should not.
constexpr double kMostHandExcess = 1.8;
constexpr double kMostImageExcess = 6.0;
constexpr double kMostOutliers = 0.35;
constexpr double kSearchStep_rad = 30.0 * kPi / 180.0;
constexpr std::size_t kSearchFrames = 14;
constexpr int kSearchIterations = 4;

WatchUnknowns begin_at(std::span<const WatchFrame> frames, const Pose& hand_from_eye,
                       std::vector<WatchTrack> tracks) {
  WatchUnknowns at{
      .start = hand_from_eye, .hand_from_eye = hand_from_eye, .tracks = std::move(tracks)};
  for (const WatchFrame& frame : frames) {
    at.room_from_eye.push_back(frame.room_from_hand * hand_from_eye);
  }
  place_points(at.room_from_eye, at.tracks);
  return at;
}

/// Levenberg-Marquardt; returns the iterations.
int minimise(std::span<const WatchFrame> frames, const WatchWeights& weights, int most,
             WatchUnknowns& at) {
  settle_points(weights, at);
  double cost = watch_cost(frames, at, weights);
  double damping = 1e-4;
  int iterations = 0;
  while (iterations < most) {
    ++iterations;
    WatchUnknowns next = at;
    const bool stepped = WatchEquations(frames, at, weights, damping).step(next);
    if (stepped) settle_points(weights, next);
    const double next_cost =
        stepped ? watch_cost(frames, next, weights) : std::numeric_limits<double>::infinity();
    if (!(next_cost < cost)) {
      if (damping > 1e3) break;
      damping = std::max(damping, 1e-5) * 10.0;
      continue;
    }
    const bool converged = cost - next_cost < kConverged;
    at = std::move(next);
    cost = next_cost;
    damping *= 0.1;
    if (converged) break;
  }
  return iterations;
}

struct ImageResiduals {
  double squared{0};  ///< of the inliers
  std::size_t inliers{0};
  std::size_t sights{0};
  std::size_t tracks{0};  ///< that have inliers
};

ImageResiduals image_residuals(const WatchUnknowns& at, const WatchWeights& weights) {
  ImageResiduals found;
  for (const WatchTrack& track : at.tracks) {
    bool any = false;
    for (const WatchTrack::Sight& sight : track.sights) {
      ++found.sights;
      const auto seen = watch_ray(track, at.room_from_eye[static_cast<std::size_t>(sight.frame)]);
      if (!seen || (*seen - sight.ray).norm() > weights.robust_image) continue;
      found.squared += (*seen - sight.ray).squaredNorm();
      ++found.inliers;
      any = true;
    }
    found.tracks += any ? 1 : 0;
  }
  return found;
}

/// What the equations at the answer say about it.
bool conclude(std::span<const WatchFrame> frames, const WatchUnknowns& at,
              const WatchWeights& weights, WatchFit& fit) {
  const WatchEquations equations(frames, at, weights, 0.0);
  const Eigen::LLT<Eigen::MatrixXd> factor(equations.matrix());
  if (factor.info() != Eigen::Success) return false;
  const Eigen::Index size = equations.matrix().rows();
  const Eigen::MatrixXd covariance = factor.solve(Eigen::MatrixXd::Identity(size, size));
  const Eigen::Index common = size - kWatchCommon;
  double chi2 = 0;
  double freedom = 0;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const auto hand = watch_hand_residual(frames[k], at.room_from_eye[k], at);
    const auto row = static_cast<Eigen::Index>(6 * k);
    const auto across =
        (covariance.block<6, kWatchCommon>(row, common) * hand.by_common.transpose()).eval();
    const Matrix6d adjusted = covariance.block<6, 6>(row, row) - across - across.transpose() +
                              hand.by_common *
                                  covariance.bottomRightCorner<kWatchCommon, kWatchCommon>() *
                                  hand.by_common.transpose();
    chi2 += hand.residual.dot(hand.information * hand.residual);
    freedom += 6.0 - (hand.information * adjusted).trace();
  }
  const ImageResiduals image = image_residuals(at, weights);
  const double all = 2.0 * static_cast<double>(image.inliers) -
                     3.0 * static_cast<double>(image.tracks) - kWatchCommon;
  fit.hand_excess = chi2 / std::max(1.0, freedom);
  fit.image_excess = image.squared / (weights.image * weights.image) / std::max(1.0, all - freedom);
  fit.outliers = 1.0 - static_cast<double>(image.inliers) / static_cast<double>(image.sights);
  fit.covariance =
      std::max({1.0, fit.hand_excess, fit.image_excess}) * covariance.block<6, 6>(common, common);
  fit.hand_from_eye = at.hand_from_eye;
  return fit.covariance.allFinite() && std::isfinite(fit.cost);
}

}  // namespace

std::optional<WatchFit> watch_fit(std::span<const WatchFrame> frames, const Pose& start,
                                  const WatchFitOptions& options) {
  std::vector<WatchTrack> tracks = watch_tracks(frames, options.min_sights);
  if (static_cast<int>(tracks.size()) < options.min_tracks) return std::nullopt;
  WatchUnknowns at = begin_at(frames, start, std::move(tracks));
  WatchWeights weights{.image = options.image_noise,
                       .robust_image = kWideBend * options.image_noise,
                       .time_offset_s = options.time_offset_s,
                       .hold_rotation_rad = options.held_rotation_rad,
                       .hold_translation_mm = options.held_translation_mm};
  WatchFit fit;
  fit.iterations = minimise(frames, weights, options.max_iterations / 2, at);
  weights.robust_image = kBend * options.image_noise;
  fit.iterations += minimise(frames, weights, options.max_iterations, at);
  fit.held_cost = watch_cost(frames, at, weights);
  weights.hold_rotation_rad = kFree_rad;
  weights.hold_translation_mm = kFree_mm;
  fit.iterations += minimise(frames, weights, 2 * options.max_iterations, at);
  fit.cost = watch_cost(frames, at, weights);
  if (!conclude(frames, at, weights, fit)) return std::nullopt;
  return fit;
}

bool explains(const WatchFit& fit) {
  return fit.hand_excess < kMostHandExcess && fit.image_excess < kMostImageExcess &&
         fit.outliers < kMostOutliers;
}

std::optional<WatchFit> watch_search(std::span<const WatchFrame> frames, const Pose& start,
                                     const WatchFitOptions& options) {
  std::vector<WatchFrame> some;
  const std::size_t count = std::min(frames.size(), kSearchFrames);
  for (std::size_t i = 0; i < count; ++i) some.push_back(frames[i * frames.size() / count]);
  WatchFitOptions quick = options;
  quick.max_iterations = kSearchIterations;
  quick.held_rotation_rad = kFree_rad;
  quick.held_translation_mm = kFree_mm;
  std::optional<WatchFit> best;
  for (double angle = 0; angle < 2.0 * kPi - 0.1; angle += kSearchStep_rad) {
    Pose turned = start;
    turned.linear() = start.linear() * exp_so3({0.0, 0.0, angle});
    const auto fit = watch_fit(some, turned, quick);
    if (fit && (!best || fit->cost < best->cost)) best = fit;
  }
  if (!best) return std::nullopt;
  return watch_fit(frames, best->hand_from_eye, options);
}

}  // namespace handeye
