// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/sync/clock_model.hpp"

#include <algorithm>
#include <cmath>

namespace handeye {
namespace {

constexpr double kDay_s = 86400.0;

double seconds_from_ns(std::int64_t duration_ns) {
  return static_cast<double>(duration_ns) * 1e-9;
}

std::int64_t ns_from_seconds(double duration_s) {
  return std::llround(duration_s * 1e9);
}

}  // namespace

ClockModel::ClockModel(const ClockModelOptions& options) : options_(options) {}

std::int64_t ClockModel::observe(double device_s, std::int64_t arrival_ns) {
  if (!std::isfinite(device_s)) return arrival_ns;
  if (!started_) start(device_s, arrival_ns);

  const double device = unwrapped(device_s, arrival_ns) - origin_device_s_;
  const double arrival = seconds_from_ns(arrival_ns - origin_ns_);
  const Point point{device, arrival - device};
  if (std::abs(point.lateness_s - line_.at(device)) > believable_s(device)) {
    if (!confirms_jump(point)) {
      return std::min(origin_ns_ + ns_from_seconds(device + line_.at(device)), arrival_ns);
    }
    ++restarts_;
    start(device_s, arrival_ns);
    return arrival_ns;
  }

  if (device - (last_device_s_ - origin_device_s_) > options_.window_s) {
    start(device_s, arrival_ns);  // nothing of the window is left after such a pause
    return arrival_ns;
  }

  suspects_ = 0;
  last_device_s_ = device + origin_device_s_;
  last_arrival_ns_ = arrival_ns;
  if (insert(point)) {
    const double before = line_.at(device) + correction_s_;
    fit();
    correction_s_ = before - line_.at(device);
  }
  settle(device);
  return origin_ns_ + ns_from_seconds(device + line_.at(device) + correction_s_);
}

/// The seconds of the day, counted on from the last observation's day: the day is the one that the
/// host's clock expects, so midnight is found after any pause.
double ClockModel::unwrapped(double device_s, std::int64_t arrival_ns) const {
  const double expected = last_device_s_ + seconds_from_ns(arrival_ns - last_arrival_ns_);
  return device_s + kDay_s * std::round((expected - device_s) / kDay_s);
}

void ClockModel::start(double device_s, std::int64_t arrival_ns) {
  started_ = true;
  origin_ns_ = last_arrival_ns_ = arrival_ns;
  origin_device_s_ = last_device_s_ = device_s;
  first_ = count_ = 0;
  line_ = {};
  correction_s_ = settled_at_s_ = 0;
  suspects_ = 0;
  insert({});
}

/// A jump shows the same new lateness several times while both clocks run on. Datagrams that a
/// stalled network delivers all at once do not: they arrive together and catch up.
bool ClockModel::confirms_jump(const Point& suspect) {
  const double device_passed = suspect.device_s - first_suspect_.device_s;
  const double change = suspect.lateness_s - first_suspect_.lateness_s;
  const double arrival_passed = device_passed + change;
  const bool goes_on = suspects_ > 0 && std::abs(change) <= 0.5 * options_.jump_s &&
                       device_passed > 0 && arrival_passed >= 0.5 * device_passed;
  if (!goes_on) {
    first_suspect_ = suspect;
    suspects_ = 0;
  }
  return ++suspects_ >= options_.jump_confirmations;
}

/// How far from the mapping a stamp may lie: a jump's size, and after a pause what drift explains.
double ClockModel::believable_s(double device_s) const {
  const double pause_s = std::abs(device_s - (last_device_s_ - origin_device_s_));
  return options_.jump_s + 2.0 * options_.max_drift * pause_s;
}

/// Files the point under its slice; true when the envelope may have changed.
bool ClockModel::insert(const Point& point) {
  const double width_s = options_.window_s / static_cast<double>(kSlices);
  const auto slice = static_cast<std::int64_t>(std::floor(point.device_s / width_s));
  bool changed = false;
  while (count_ > 0 && slices_[first_].lowest.device_s < point.device_s - options_.window_s) {
    first_ = (first_ + 1) % kSlices;
    --count_;
    changed = true;
  }
  if (count_ > 0 && slice <= newest_slice_) {
    auto& [lowest, observations] = slices_[(first_ + count_ - 1) % kSlices];
    observations += 1;
    const double expected = lowest.lateness_s + line_.slope * (point.device_s - lowest.device_s);
    // A datagram overtaken by its successor must not upset the order of the points.
    if (point.lateness_s >= expected || point.device_s < lowest.device_s) return changed;
    lowest = point;
    return true;
  }
  if (count_ == kSlices) {
    first_ = (first_ + 1) % kSlices;
    --count_;
  }
  slices_[(first_ + count_) % kSlices] = {point, 1};
  ++count_;
  newest_slice_ = slice;
  return true;
}

void ClockModel::fit() {
  std::array<Point, kSlices> hull;  // lower convex hull, left to right (Andrew's monotone chain)
  std::size_t size = 0;
  double mean_device = 0;
  double observations = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const Slice& slice = slices_[(first_ + i) % kSlices];
    const Point& point = slice.lowest;
    observations += slice.observations;
    mean_device += (point.device_s - mean_device) * slice.observations / observations;
    const auto above_chord = [&](const Point& a, const Point& b) {
      return (b.lateness_s - a.lateness_s) * (point.device_s - a.device_s) >=
             (point.lateness_s - a.lateness_s) * (b.device_s - a.device_s);
    };
    while (size >= 2 && above_chord(hull[size - 2], hull[size - 1])) --size;
    hull[size++] = point;
  }

  // The line nearest to all points from below supports the hull below their mean.
  std::size_t edge = 0;
  while (edge + 2 < size && hull[edge + 1].device_s < mean_device) ++edge;
  const auto slope_after = [&](std::size_t i) {
    return (hull[i + 1].lateness_s - hull[i].lateness_s) /
           (hull[i + 1].device_s - hull[i].device_s);
  };
  const double free_slope =
      size >= 2 && hull[edge + 1].device_s > hull[edge].device_s ? slope_after(edge) : 0.0;
  const double slope = std::clamp(free_slope, -options_.max_drift, options_.max_drift);

  // With the slope at its limit the line rests on another vertex.
  const auto height = [&](const Point& p) { return p.lateness_s - slope * p.device_s; };
  const Point support =
      *std::min_element(hull.begin(), hull.begin() + static_cast<std::ptrdiff_t>(size),
                        [&](const Point& a, const Point& b) { return height(a) < height(b); });
  line_ = {support.device_s, support.lateness_s, slope};
}

/// The envelope steps when a lower point comes or an old one leaves. A step in the stamps would be
/// a jerk of the hand, so the mapping glides; by at most half of the time passed, that it never
/// runs backwards.
void ClockModel::settle(double device_s) {
  const double passed = std::max(0.0, device_s - settled_at_s_);
  settled_at_s_ = std::max(settled_at_s_, device_s);
  const double wanted = correction_s_ * -std::expm1(-passed / options_.settling_s);
  correction_s_ -= std::clamp(wanted, -0.5 * passed, 0.5 * passed);
}

}  // namespace handeye
