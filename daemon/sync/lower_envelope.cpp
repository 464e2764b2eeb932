// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/sync/lower_envelope.hpp"

#include <algorithm>
#include <cmath>

namespace handeye {
namespace {

// Of the lowest points of a full window so many lie below the line; of a young one ever fewer, for
// it has none to spare.
constexpr double kBelow = 0.1;
// Trackers stamp within 0.5 ms (ART's own figure): what is so much earlier than the line is no
// noise.
constexpr double kNoise_s = 0.0015;
// Halvings of the slope's range: to below 1e-9.
constexpr int kHalvings = 20;

}  // namespace

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

/// Files the point under its slice; true when the line may lie elsewhere now: a slice's lowest
/// point that is not below the line holds it nowhere.
bool LowerEnvelope::file(const Point& point) {
  const double width_s = window_s_ / static_cast<double>(kSlices);
  const auto number = static_cast<std::int64_t>(std::floor(point.device_s / width_s));
  while (count_ > 0 && slice(0).lowest.device_s < point.device_s - window_s_) drop_oldest();
  if (count_ > 0 && number <= newest_slice_) {
    auto& [lowest, observations] = slices_[(first_ + count_ - 1) % kSlices];
    observations += 1;
    const double expected = lowest.lateness_s + slope_ * (point.device_s - lowest.device_s);
    // A datagram overtaken by its successor must not upset the order of the points.
    if (point.lateness_s >= expected || point.device_s < lowest.device_s) return false;
    lowest = point;
    return point.lateness_s < at(point.device_s);
  }
  if (count_ == kSlices) drop_oldest();
  slices_[(first_ + count_) % kSlices] = {point, 1};
  ++count_;
  newest_slice_ = number;
  return true;
}

/// With the slope given the height is a quantile of the points, and the sum of their losses, which
/// is convex in the slope, falls with it by `pull`.
LowerEnvelope::Fit LowerEnvelope::fit_height(double slope) const {
  struct Height {
    double height_s{0};
    std::size_t slice{0};
  };
  std::array<Height, kSlices> heights{};
  const double filled = (slice(count_ - 1).lowest.device_s - slice(0).lowest.device_s) / window_s_;
  const double share = kBelow * filled;
  double all = 0.0;
  double all_times_s = 0.0;
  for (std::size_t i = 0; i < count_; ++i) {
    heights[i] = {slice(i).lowest.lateness_s - slope * since_begin_s(i), i};
    all += slice(i).observations;
    all_times_s += slice(i).observations * since_begin_s(i);
  }
  // The lowest on top; those of a height in order of time, so that the answer is one.
  const auto is_above = [](const Height& a, const Height& b) {
    return a.height_s != b.height_s ? a.height_s > b.height_s : a.slice > b.slice;
  };
  auto* end = heights.begin() + static_cast<std::ptrdiff_t>(count_);
  std::make_heap(heights.begin(), end, is_above);
  Fit fit{.lowest_s = heights.front().height_s};
  double below = 0.0;
  double below_times_s = 0.0;
  for (;; std::pop_heap(heights.begin(), end--, is_above)) {
    const std::size_t on_line = heights.front().slice;
    const double weight = slice(on_line).observations;
    if (below + weight > share * all) {
      fit.height_s = heights.front().height_s;
      // What lies on the line weighs as much as all others together, against them.
      fit.pull =
          share * all_times_s - below_times_s - (share * all - below) * since_begin_s(on_line);
      return fit;
    }
    below += weight;
    below_times_s += weight * since_begin_s(on_line);
  }
}

void LowerEnvelope::fit() {
  double least = -max_slope_;
  double most = max_slope_;
  if (count_ == 1) least = most = 0;
  for (int i = 0; i < kHalvings && least < most; ++i) {
    const double middle = 0.5 * (least + most);
    (fit_height(middle).pull > 0 ? least : most) = middle;
  }
  slope_ = 0.5 * (least + most);
  const Fit fit = fit_height(slope_);
  // A slope at its limit joins what came by a longer way and what came by a shorter one.
  const bool is_at_limit = least == -max_slope_ || most == max_slope_;
  const bool is_noise = !is_at_limit && fit.lowest_s > fit.height_s - kNoise_s;
  line_ = {slice(0).lowest.device_s, is_noise ? fit.height_s : fit.lowest_s};
}

}  // namespace handeye
