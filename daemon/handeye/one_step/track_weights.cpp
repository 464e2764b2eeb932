// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/one_step/track_weights.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace handeye {
namespace {

constexpr double kChance = 3.0;      // standard deviations
constexpr double kDifferent = 0.05;  // relative, root of the mean square

/// A track's squares over its variance, expected 1 each by `freedom` errors that are left.
struct TrackSquares {
  double freedom{1};
  double squares{0};
};

std::vector<TrackSquares> squares_of(const MetricScene& scene, const ImageRows& rows,
                                     double image_px) {
  std::vector<TrackSquares> result;
  result.reserve(scene.points());
  for (std::size_t j = 0; j < scene.points(); ++j) {
    const std::size_t seen = scene.first_of_point[j + 1] - scene.first_of_point[j];
    result.push_back({std::max(1.0, 2.0 * static_cast<double>(seen) - 3.0),
                      rows.squares_of_tracks[j] / (image_px * image_px)});
  }
  return result;
}

/// Of Student's distribution: by how much more tracks differ than equal ones would by chance. With
/// nu degrees of freedom variances scatter by 2 / (nu - 4) about their mean. Nothing: not at all.
std::optional<double> students_freedom(const std::vector<TrackSquares>& tracks) {
  double scatter = 0;
  double chance = 0;
  double freedom = 0;
  for (const TrackSquares& track : tracks) {
    const double off = track.squares / track.freedom - 1.0;
    scatter += track.freedom * off * off - 2.0;
    chance += 8.0 + 48.0 / track.freedom;  // its variance, for chi2
    freedom += track.freedom;
  }
  const double excess = (scatter - kChance * std::sqrt(chance)) / freedom;
  if (!(excess > 0)) return std::nullopt;
  return 4.0 + 2.0 / excess;
}

}  // namespace

std::vector<double> track_weights(const MetricScene& scene, const ImageRows& rows,
                                  double image_px) {
  const std::vector<TrackSquares> tracks = squares_of(scene, rows, image_px);
  const auto freedom = students_freedom(tracks);
  if (!freedom) return std::vector<double>(tracks.size(), 1.0);
  std::vector<double> weights;
  weights.reserve(tracks.size());
  for (const TrackSquares& track : tracks) {
    weights.push_back((*freedom + track.freedom) / (*freedom + track.squares));
  }
  return weights;
}

bool differ(const std::vector<double>& weights, const std::vector<double>& others) {
  double sum = 0;
  for (std::size_t j = 0; j < weights.size(); ++j) {
    const double change = (weights[j] - others[j]) / std::max(weights[j], others[j]);
    sum += change * change;
  }
  return sum > kDifferent * kDifferent * static_cast<double>(weights.size());
}

}  // namespace handeye
