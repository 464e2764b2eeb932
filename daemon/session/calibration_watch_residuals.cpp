// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/session/calibration_watch_residuals.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace handeye {
namespace {

/// Inverse depths of a scene, beside the median of its points'.
constexpr double kFarthest = 1.0 / 8.0;
constexpr double kNearest = 4.0;
constexpr double kLeastUsual = 0.002, kLargestUsual = 0.1;  ///< 1/mm
/// Of a correlation by chance, in standard deviations.
constexpr double kByChance = 1.5;

/// What a point leaves of the freedom of its sights.
double freedom(const WatchTrack& track) {
  return std::max(1.0, 2.0 * static_cast<double>(track.sights.size()) - 3.0);
}

/// Per axis, as an estimate of the image noise.
double error_of(const WatchTrack& track, const std::vector<Pose>& room_from_eye) {
  double squared = 0;
  for (const WatchTrack::Sight& sight : track.sights) {
    const auto seen = watch_ray(track, room_from_eye[static_cast<std::size_t>(sight.frame)]);
    squared += seen ? (*seen - sight.ray).squaredNorm() : 1.0;
  }
  return std::sqrt(squared / freedom(track));
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace

void leave_out_wild_tracks(double image_noise, const WatchDepth& depth, const WatchWild& wild,
                           WatchUnknowns& at) {
  if (at.tracks.empty()) return;
  std::vector<double> errors;
  for (const WatchTrack& track : at.tracks) errors.push_back(error_of(track, at.room_from_eye));
  const double usual = std::max(median(errors), image_noise);
  std::vector<WatchTrack> steady;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    WatchTrack& track = at.tracks[i];
    const double most = wild.most_times + wild.most_sigmas / std::sqrt(2.0 * freedom(track));
    const bool before_the_lens = track.point.z() >= depth.largest;
    if (errors[i] <= most * usual && !before_the_lens) steady.push_back(std::move(track));
  }
  at.tracks = std::move(steady);
}

WatchDepth scene_depth(const WatchUnknowns& at) {
  if (at.tracks.empty()) return {};
  std::vector<double> inverse;
  for (const WatchTrack& track : at.tracks) inverse.push_back(track.point.z());
  const double usual = std::clamp(median(std::move(inverse)), kLeastUsual, kLargestUsual);
  return {.usual = usual, .sigma = usual, .least = kFarthest * usual, .largest = kNearest * usual};
}

WatchImageResiduals watch_image_residuals(const WatchUnknowns& at, double within) {
  WatchImageResiduals found;
  for (const WatchTrack& track : at.tracks) {
    bool any = false;
    for (const WatchTrack::Sight& sight : track.sights) {
      ++found.sights;
      const auto seen = watch_ray(track, at.room_from_eye[static_cast<std::size_t>(sight.frame)]);
      if (!seen || (*seen - sight.ray).norm() > within) continue;
      found.squared += (*seen - sight.ray).squaredNorm();
      ++found.inliers;
      any = true;
    }
    found.tracks += any ? 1 : 0;
  }
  return found;
}

double watch_hand_chi2(std::span<const WatchFrame> frames, const WatchUnknowns& at) {
  double chi2 = 0;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const auto hand = watch_hand_residual(frames[k], at.room_from_eye[k], at);
    chi2 += hand.residual.dot(hand.information * hand.residual);
  }
  return chi2;
}

double watch_hand_lasting(std::span<const WatchFrame> frames, const WatchUnknowns& at) {
  std::vector<Vector6d> white;
  double all = 0;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const auto hand = watch_hand_residual(frames[k], at.room_from_eye[k], at);
    const Eigen::LLT<Matrix6d> factor(hand.information);
    white.emplace_back(factor.matrixU() * hand.residual);
    all += white.back().squaredNorm();
  }
  const double least = kByChance / std::sqrt(6.0 * static_cast<double>(frames.size()));
  double widened = 1.0;
  for (std::size_t lag = 1; lag <= frames.size() / 4; ++lag) {
    double both = 0;
    for (std::size_t k = lag; k < white.size(); ++k) both += white[k].dot(white[k - lag]);
    if (!(both > least * all)) break;
    widened += 2.0 * both / all;
  }
  return widened;
}

}  // namespace handeye
