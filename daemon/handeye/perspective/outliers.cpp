// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/handeye/perspective/outliers.hpp"

#include <algorithm>

namespace handeye {
namespace {

constexpr double kGross = 6.0;            // standard deviations per axis
constexpr double kMedianOfNorm = 1.1774;  // of two such axes' norm
constexpr double kWorstPart = 0.5;        // an outlier bends the rest, so the worst go first
constexpr double kRounding_px = 1e-4;     // errors below it are gross in no image

double median(std::span<const double> values) {
  std::vector<double> sorted(values.begin(), values.end());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

}  // namespace

std::vector<std::size_t> gross_outliers(const Observations& observations,
                                        std::span<const double> errors_px) {
  if (errors_px.empty()) return {};
  const double worst_px = *std::ranges::max_element(errors_px);
  const double limit_px =
      std::max({kGross * median(errors_px) / kMedianOfNorm, kWorstPart * worst_px, kRounding_px});
  std::vector<std::size_t> gross;
  std::size_t place = 0;
  for (const ObservedPosition& position : observations.positions) {
    const std::size_t before = gross.size();
    for (std::size_t i = 0; i < position.points.size(); ++i, ++place) {
      if (errors_px[place] > limit_px) gross.push_back(place);
    }
    if (2 * (gross.size() - before) > position.points.size()) return {};
  }
  return gross;
}

Observations without_points(const Observations& observations, std::span<const std::size_t> places) {
  Observations rest = observations;
  std::size_t place = 0;
  for (ObservedPosition& position : rest.positions) {
    std::vector<ObjectPoint> kept;
    for (const ObjectPoint& point : position.points) {
      if (!std::ranges::binary_search(places, place++)) kept.push_back(point);
    }
    position.points = std::move(kept);
  }
  return rest;
}

}  // namespace handeye
