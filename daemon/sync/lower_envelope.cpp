// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/sync/lower_envelope.hpp"

#include <algorithm>
#include <cmath>

namespace handeye {

bool LowerEnvelope::insert(const Point& point) {
  if (!file(point)) return false;
  fit();
  return true;
}

void LowerEnvelope::clear() {
  first_ = count_ = 0;
  line_ = {};
  slope_ = 0;
}

void LowerEnvelope::drop_oldest() {
  first_ = (first_ + 1) % kSlices;
  --count_;
}

/// Files the point under its slice; true when the envelope may have changed.
bool LowerEnvelope::file(const Point& point) {
  const double width_s = window_s_ / static_cast<double>(kSlices);
  const auto number = static_cast<std::int64_t>(std::floor(point.device_s / width_s));
  bool changed = false;
  while (count_ > 0 && slice(0).lowest.device_s < point.device_s - window_s_) {
    drop_oldest();
    changed = true;
  }
  if (count_ > 0 && number <= newest_slice_) {
    auto& [lowest, observations] = slices_[(first_ + count_ - 1) % kSlices];
    observations += 1;
    const double expected = lowest.lateness_s + slope_ * (point.device_s - lowest.device_s);
    // A datagram overtaken by its successor must not upset the order of the points.
    if (point.lateness_s >= expected || point.device_s < lowest.device_s) return changed;
    lowest = point;
    return true;
  }
  if (count_ == kSlices) drop_oldest();
  slices_[(first_ + count_) % kSlices] = {point, 1};
  ++count_;
  newest_slice_ = number;
  return true;
}

/// Andrew's monotone chain.
LowerEnvelope::Hull LowerEnvelope::hull() const {
  Hull hull;
  auto& [points, size, mean_device_s] = hull;
  double observations = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const Point& point = slice(i).lowest;
    observations += slice(i).observations;
    mean_device_s += (point.device_s - mean_device_s) * slice(i).observations / observations;
    const auto above_chord = [&](const Point& a, const Point& b) {
      return (b.lateness_s - a.lateness_s) * (point.device_s - a.device_s) >=
             (point.lateness_s - a.lateness_s) * (b.device_s - a.device_s);
    };
    while (size >= 2 && above_chord(points[size - 2], points[size - 1])) --size;
    points[size++] = point;
  }
  return hull;
}

void LowerEnvelope::fit() {
  const Hull hull = this->hull();
  // The line nearest to all points from below supports the hull below their mean.
  std::size_t edge = 0;
  while (edge + 2 < hull.size && hull.points[edge + 1].device_s < hull.mean_device_s) ++edge;
  double free_slope = 0;
  if (hull.size >= 2) {
    const Point& a = hull.points[edge];
    const Point& b = hull.points[edge + 1];
    if (b.device_s > a.device_s) {
      free_slope = (b.lateness_s - a.lateness_s) / (b.device_s - a.device_s);
    }
  }
  slope_ = std::clamp(free_slope, -max_slope_, max_slope_);

  // With the slope at its limit the line rests on another vertex.
  const auto height = [&](const Point& p) { return p.lateness_s - slope_ * p.device_s; };
  line_ = *std::min_element(hull.points.begin(),
                            hull.points.begin() + static_cast<std::ptrdiff_t>(hull.size),
                            [&](const Point& a, const Point& b) { return height(a) < height(b); });
}

}  // namespace handeye
