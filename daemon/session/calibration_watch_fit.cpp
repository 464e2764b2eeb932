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
/// Features are off for as long as they live: measured, the rotation's variance is 1.2 times what
/// independent errors make it, where features walk off a lot more.
constexpr double kCorrelation = 1.3;
/// Expected fall of the cost by another step, of which 0.5 is one standard deviation.
constexpr double kConverged = 0.05;
/// Of a feature that goes its own way, in what features are off usually.
constexpr double kWild = 3.0;
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

struct Descent {
  int iterations{0};
  bool converged{false};
};

/// Levenberg-Marquardt.
Descent minimise(std::span<const WatchFrame> frames, const WatchWeights& weights, int most,
                 WatchUnknowns& at) {
  settle_points(weights, at);
  double cost = watch_cost(frames, at, weights);
  double damping = 1e-5;
  Descent descent;
  while (descent.iterations < most && damping < 1e3) {
    ++descent.iterations;
    WatchUnknowns next = at;
    const auto expected = WatchEquations(frames, at, weights, damping).step(frames, next);
    descent.converged = expected && *expected < kConverged && damping < 1e-2;
    if (expected) settle_points(weights, next);
    const double next_cost =
        expected ? watch_cost(frames, next, weights) : std::numeric_limits<double>::infinity();
    if (next_cost < cost) {
      at = std::move(next);
      cost = next_cost;
      damping = std::max(1e-9, 0.1 * damping);
    } else {
      damping = std::max(damping, 1e-5) * 10.0;
    }
    if (descent.converged) break;
  }
  return descent;
}

double mean_error(const WatchTrack& track, const std::vector<Pose>& room_from_eye) {
  double squared = 0;
  for (const WatchTrack::Sight& sight : track.sights) {
    const auto seen = watch_ray(track, room_from_eye[static_cast<std::size_t>(sight.frame)]);
    squared += seen ? (*seen - sight.ray).squaredNorm() : 1.0;
  }
  return std::sqrt(squared / static_cast<double>(track.sights.size()));
}

/// Leaves out features that slide, or are no point: sight by sight a robust loss would go on
/// choosing which of theirs to believe, and the descent never ends.
void leave_out_wild_tracks(double image_noise, WatchUnknowns& at) {
  std::vector<double> errors;
  for (const WatchTrack& track : at.tracks) errors.push_back(mean_error(track, at.room_from_eye));
  std::vector<double> sorted = errors;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::ranges::nth_element(sorted, middle);
  const double most = kWild * std::max(*middle, image_noise);
  std::vector<WatchTrack> steady;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (errors[i] <= most) steady.push_back(std::move(at.tracks[i]));
  }
  at.tracks = std::move(steady);
}

struct ImageResiduals {
  double squared{0};  ///< of the inliers
  std::size_t inliers{0}, sights{0};
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

double hand_chi2(std::span<const WatchFrame> frames, const WatchUnknowns& at) {
  double chi2 = 0;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const auto hand = watch_hand_residual(frames[k], at.room_from_eye[k], at);
    chi2 += hand.residual.dot(hand.information * hand.residual);
  }
  return chi2;
}

/// The cost with hand_from_eye held near the calibration, found from what explains the frames best
/// without: where the calibration can explain the same points and eyes, it is not to blame.
Descent hold_again(std::span<const WatchFrame> frames, const WatchWeights& held,
                   const Pose& calibrated, WatchUnknowns at, WatchFit& fit) {
  const WatchUnknowns common{.hand_from_eye = calibrated,
                             .time_offset_correction_s = at.time_offset_correction_s};
  const auto size = static_cast<Eigen::Index>(6 * frames.size());
  carry_eyes(frames, common, Eigen::VectorXd::Zero(size), at);
  at.start = calibrated;
  const Descent descent = minimise(frames, held, kMostClosely, at);
  fit.held_cost = watch_cost(frames, at, held);
  fit.iterations += descent.iterations;
  return descent;
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
  const ImageResiduals image = image_residuals(at, weights);
  const double all = 2.0 * static_cast<double>(image.inliers) -
                     3.0 * static_cast<double>(image.tracks) - kWatchCommon;
  fit.hand_excess = hand_chi2(frames, at) / std::max(1.0, freedom);
  fit.image_excess = image.squared / (weights.image * weights.image) / std::max(1.0, all - freedom);
  fit.outliers = 1.0 - static_cast<double>(image.inliers) / static_cast<double>(image.sights);
  fit.covariance = kCorrelation * std::max({1.0, fit.hand_excess, fit.image_excess}) *
                   covariance.block<6, 6>(common, common);
  fit.gain = 2.0 * (fit.held_cost - fit.cost) /
             (kCorrelation * std::max({1.0, fit.hand_excess, fit.image_excess}));
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
  fit.iterations = minimise(frames, held, options.max_iterations / 2, at).iterations;
  leave_out_wild_tracks(options.image_noise, at);
  held.robust_image = kBend * options.image_noise;
  fit.iterations += minimise(frames, held, options.max_iterations, at).iterations;
  fit.held_cost = watch_cost(frames, at, held);

  WatchWeights free = held;
  free.hold_rotation_rad = kFree_rad;
  free.hold_translation_mm = kFree_mm;
  Descent descent = minimise(frames, free, 2 * options.max_iterations, at);
  fit.iterations += descent.iterations;
  const bool suspicious = 2.0 * (fit.held_cost - watch_cost(frames, at, free)) > kUsualGain ||
                          !start.isApprox(calibrated);
  const double hopeless = kHopeless * 6.0 * static_cast<double>(frames.size());
  if (suspicious && hand_chi2(frames, at) < hopeless) {
    leave_out_wild_tracks(options.image_noise, at);
    descent = minimise(frames, free, kMostClosely, at);
    fit.iterations += descent.iterations;
    const Descent again = hold_again(frames, held, calibrated, at, fit);
    const double left = 2.0 * (fit.held_cost - watch_cost(frames, at, free));
    descent.converged &= again.converged || left > kBeyondReach;
  }
  fit.cost = watch_cost(frames, at, free);
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
