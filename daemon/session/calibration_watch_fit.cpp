// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/calibration_watch_fit.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "daemon/session/calibration_watch_descent.hpp"
#include "daemon/session/calibration_watch_residuals.hpp"

namespace handeye {
namespace {

/// Where the loss bends, in standard deviations of the image noise: first wide, for a start may be
/// far off, then as outliers deserve.
constexpr double kWideBend = 40.0;
constexpr double kBend = 4.0;
/// Features are off for as long as they live: measured, the rotation's variance is 1.2 times what
/// independent errors make it, where features walk off a lot more.
constexpr double kCorrelation = 1.3;
/// Iterations with the loss, before it is settled which sights are believed.
constexpr int kChoosing = 6, kChoosingOn = 4;
/// Features that slide are seen only when all else fits.
constexpr WatchWild kFirstWild{.most_times = 3.0, .most_sigmas = 0.0};
constexpr WatchWild kWild{.most_times = 1.0, .most_sigmas = 4.0};
/// What the hand's residuals are larger than they should be by more than chance is taken for an
/// error that lasts over so many frames.
constexpr double kUsualExcess = 1.1;
constexpr double kLastingFrames = 20.0;
/// What a fit without the calibration gains by chance; more is to be looked at closely.
constexpr double kUsualGain = 20.0;
constexpr int kMostClosely = 40;  ///< iterations
/// Chi2 of the hand, each of its numbers, beyond which frames will not come to explain each other.
constexpr double kHopeless = 4.0;
/// A gain that no further iterations with the calibration held would take away.
constexpr double kBeyondReach = 2000.0;
constexpr double kFree_rad = 0.3, kFree_mm = 30.0;  ///< what the motion does not tell stays there
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

/// The cost with hand_from_eye held near the calibration, found from what explains the frames best
/// without: where the calibration can explain the same points and eyes, it is not to blame.
WatchDescent hold_again(std::span<const WatchFrame> frames, const WatchWeights& held,
                        const Pose& calibrated, WatchUnknowns at, WatchFit& fit) {
  const WatchUnknowns common{.hand_from_eye = calibrated,
                             .time_offset_correction_s = at.time_offset_correction_s};
  const auto size = static_cast<Eigen::Index>(6 * frames.size());
  carry_eyes(frames, common, Eigen::VectorXd::Zero(size), at);
  at.start = calibrated;
  const WatchDescent descent = watch_descend(frames, held, kMostClosely, at);
  fit.held_cost = watch_cost(frames, at, held);
  fit.iterations += descent.iterations;
  return descent;
}

/// As the residuals show it, or as far as it hides in hand_from_eye and shows in their size alone.
double lasting(double shown, const WatchFit& fit) {
  const double hidden = 1.0 + kLastingFrames * std::max(0.0, fit.hand_excess - kUsualExcess);
  return std::max(shown, hidden / std::max({1.0, fit.hand_excess, fit.image_excess}));
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
  double freedom = 0;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const auto hand = watch_hand_residual(frames[k], at.room_from_eye[k], at);
    const auto row = static_cast<Eigen::Index>(6 * k);
    freedom += 6.0 - (hand.information * covariance.block<6, 6>(row, row)).trace();
  }
  const WatchImageResiduals image = watch_image_residuals(at, kBend * weights.image);
  const double all = 2.0 * static_cast<double>(image.inliers) -
                     3.0 * static_cast<double>(image.tracks) - kWatchCommon;
  fit.hand_excess = watch_hand_chi2(frames, at) / std::max(1.0, freedom);
  fit.image_excess = image.squared / (weights.image * weights.image) / std::max(1.0, all - freedom);
  fit.outliers = 1.0 - static_cast<double>(image.inliers) / static_cast<double>(image.sights);
  const double widened = kCorrelation * std::max({1.0, fit.hand_excess, fit.image_excess});
  fit.covariance = widened * covariance.block<6, 6>(common, common);
  fit.lasting = lasting(watch_hand_lasting(frames, at), fit);
  fit.gain = 2.0 * (fit.held_cost - fit.cost) / (widened * fit.lasting);
  fit.hand_from_eye = at.hand_from_eye;
  return fit.covariance.allFinite() && std::isfinite(fit.cost);
}

}  // namespace

std::optional<WatchFit> watch_fit(std::span<const WatchFrame> frames, const Pose& start,
                                  const Pose& calibrated, const WatchFitOptions& options) {
  std::vector<WatchTrack> tracks = watch_tracks(frames, options.min_sights);
  if (static_cast<int>(tracks.size()) < options.min_tracks) return std::nullopt;
  WatchUnknowns at = begin_at(frames, start, std::move(tracks));
  WatchWeights held{.image = options.image_noise,
                    .robust_image = kWideBend * options.image_noise,
                    .time_offset_s = options.time_offset_s,
                    .hold_rotation_rad = options.held_rotation_rad,
                    .hold_translation_mm = options.held_translation_mm};
  WatchFit fit;
  const auto descend = [&](const WatchWeights& weights, int most) {
    const WatchDescent descent = watch_descend(frames, weights, most, at);
    fit.iterations += descent.iterations;
    return descent;
  };
  descend(held, options.max_iterations / 2);
  leave_out_wild_tracks(options.image_noise, held.depth, kFirstWild, at);
  held.depth = scene_depth(at);
  held.robust_image = kBend * options.image_noise;
  descend(held, options.max_iterations);
  fit.held_cost = watch_cost(frames, at, held);

  WatchWeights free = held;
  free.hold_rotation_rad = kFree_rad;
  free.hold_translation_mm = kFree_mm;
  descend(free, kChoosing);
  leave_out_wild_tracks(options.image_noise, free.depth, kWild, at);
  descend(free, kChoosingOn);
  const double gained = fit.held_cost - watch_cost(frames, at, free);
  freeze_trust(free, at);
  free.robust_image = held.robust_image = 0;
  WatchDescent descent = descend(free, std::min(kMostClosely, 4 * options.max_iterations));
  fit.cost = watch_cost(frames, at, free);
  fit.held_cost = fit.cost + gained;
  const bool suspicious = 2.0 * gained > kUsualGain || !start.isApprox(calibrated);
  const double hopeless = kHopeless * 6.0 * static_cast<double>(frames.size());
  if (suspicious && watch_hand_chi2(frames, at) < hopeless) {
    const WatchDescent again = hold_again(frames, held, calibrated, at, fit);
    descent.converged &= again.converged || 2.0 * (fit.held_cost - fit.cost) > kBeyondReach;
  }
  fit.converged = descent.converged;
  if (!conclude(frames, at, free, fit)) return std::nullopt;
  return fit;
}

bool explains(const WatchFit& fit) {
  return fit.hand_excess < kMostHandExcess && fit.image_excess < kMostImageExcess &&
         fit.outliers < kMostOutliers;
}

std::optional<WatchFit> watch_search(std::span<const WatchFrame> frames, const Pose& calibrated,
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
    Pose turned = calibrated;
    turned.linear() = calibrated.linear() * exp_so3({0.0, 0.0, angle});
    const auto fit = watch_fit(some, turned, turned, quick);
    if (fit && (!best || fit->cost < best->cost)) best = fit;
  }
  if (!best) return std::nullopt;
  return watch_fit(frames, best->hand_from_eye, calibrated, options);
}

}  // namespace handeye
