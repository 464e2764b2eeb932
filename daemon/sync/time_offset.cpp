// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/sync/time_offset.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

namespace handeye {
namespace {

constexpr std::size_t kMinIntervals = 20;
constexpr double kMinOverlap = 0.5;  // share of the intervals that the hand must cover at an offset
constexpr double kLobeDepth = 0.05;  // a second peak lies beyond a valley this deep
// Grid points on either side that the peak is fitted to: until it has fallen well below the noise
// of the curve, for a slow motion's peak is broad.
constexpr std::size_t kLeastPeakReach = 3;
constexpr std::size_t kMostPeakReach = 20;
constexpr double kPeakDrop = 0.005;
// Speeds never agree better than this, for the motion between the samples is not known.
constexpr double kLeastLack = 0.005;
// An offset within this share of the intervals is sharp.
constexpr double kSharp = 0.1;

/// The eye's mean angular speed between two of its samples.
struct Interval {
  std::size_t from{0};
  std::size_t to{0};
  double duration_s{0};
  double speed_rad_s{0};
};

/// Hand and eye speeds at one offset. They are to be equal, not merely alike, so the coefficient is
/// 1 - mean((e - h)^2) / (2 var(e)) with one variance for all offsets: a trend in the speed, which
/// correlates with its own shifts, does not hide the offset.
struct Correlation {
  double coefficient{-1};  ///< 1: equal; not bounded below; -1 also when too few are covered
  double eye_rms{0};
  double hand_rms{0};
};

double seconds_between(const EyeSample& a, const EyeSample& b) {
  return static_cast<double>(b.timestamp_ns - a.timestamp_ns) * 1e-9;
}

/// For each sample the interval to the first one that is far enough away in time.
std::vector<Interval> intervals_of(std::span<const EyeSample> eye,
                                   const TimeOffsetOptions& options) {
  std::vector<Interval> intervals;
  intervals.reserve(eye.size());
  std::size_t to = 0;
  for (std::size_t from = 0; from < eye.size(); ++from) {
    while (to < eye.size() && seconds_between(eye[from], eye[to]) < options.interval_s) ++to;
    if (to == eye.size()) break;
    const double duration_s = seconds_between(eye[from], eye[to]);
    if (duration_s > options.max_interval_s || eye[from].part != eye[to].part) continue;
    const double angle =
        rotation_angle_rad(eye[from].eye_from_scene.linear(), eye[to].eye_from_scene.linear());
    intervals.push_back({from, to, duration_s, angle / duration_s});
  }
  return intervals;
}

double variance_of_speeds(std::span<const Interval> intervals) {
  double sum = 0, sum_of_squares = 0;
  for (const Interval& interval : intervals) {
    sum += interval.speed_rad_s;
    sum_of_squares += interval.speed_rad_s * interval.speed_rad_s;
  }
  const auto n = static_cast<double>(intervals.size());
  return sum_of_squares / n - sum / n * sum / n;
}

Correlation correlate_at(const PoseBuffer& hand, std::span<const EyeSample> eye,
                         std::span<const Interval> intervals, double speed_variance,
                         double offset_s, std::vector<HandLookup>& hand_at_eye) {
  const std::int64_t offset_ns = std::llround(offset_s * 1e9);
  for (std::size_t i = 0; i < eye.size(); ++i) {
    hand_at_eye[i] = hand.lookup(eye[i].timestamp_ns - offset_ns);
  }
  double n = 0, sum_ee = 0, sum_hh = 0, sum_difference2 = 0;
  for (const Interval& interval : intervals) {
    const HandLookup& a = hand_at_eye[interval.from];
    const HandLookup& b = hand_at_eye[interval.to];
    if (a.status != LookupStatus::kOk || b.status != LookupStatus::kOk) continue;
    const double e = interval.speed_rad_s;
    const double h = rotation_angle_rad(a.room_from_hand.linear(), b.room_from_hand.linear()) /
                     interval.duration_s;
    n += 1;
    sum_ee += e * e;
    sum_hh += h * h;
    sum_difference2 += (e - h) * (e - h);
  }
  Correlation result;
  const double needed = std::max(static_cast<double>(kMinIntervals),
                                 kMinOverlap * static_cast<double>(intervals.size()));
  if (n < needed) return result;
  result.eye_rms = std::sqrt(sum_ee / n);
  result.hand_rms = std::sqrt(sum_hh / n);
  if (speed_variance > 0) result.coefficient = 1.0 - sum_difference2 / n / (2.0 * speed_variance);
  return result;
}

struct Peak {
  double position{0};  ///< in grid steps
  double height{0};
  double curvature{0};  ///< second derivative per grid step squared, negative
};

std::size_t peak_reach(const std::vector<Correlation>& curve, std::size_t top) {
  const std::size_t room = std::min(top, curve.size() - 1 - top);
  const double fallen = curve[top].coefficient - kPeakDrop;
  std::size_t reach = kLeastPeakReach;
  while (reach < std::min(room, kMostPeakReach) &&
         std::max(curve[top - reach].coefficient, curve[top + reach].coefficient) > fallen) {
    ++reach;
  }
  return reach;
}

/// Least-squares parabola through the grid points around the highest.
std::optional<Peak> refine_peak(const std::vector<Correlation>& curve, std::size_t top) {
  if (top < kLeastPeakReach || top + kLeastPeakReach >= curve.size()) return std::nullopt;
  const auto reach = static_cast<Eigen::Index>(peak_reach(curve, top));
  Eigen::MatrixX3d powers(2 * reach + 1, 3);
  Eigen::VectorXd heights(2 * reach + 1);
  for (Eigen::Index i = 0; i < heights.size(); ++i) {
    const auto x = static_cast<double>(i - reach);
    powers.row(i) << 1, x, x * x;
    heights[i] =
        curve[top + static_cast<std::size_t>(i) - static_cast<std::size_t>(reach)].coefficient;
  }
  const Eigen::Vector3d c = powers.colPivHouseholderQr().solve(heights);
  if (!(c[2] < 0)) return std::nullopt;
  const double x = -0.5 * c[1] / c[2];
  if (std::abs(x) > static_cast<double>(reach)) return std::nullopt;
  return Peak{static_cast<double>(top) + x, c[0] + 0.5 * c[1] * x, 2.0 * c[2]};
}

/// The highest local maximum that a valley separates from the top.
double second_peak(const std::vector<Correlation>& curve, std::size_t top) {
  const auto height = [&](std::size_t i) { return curve[i].coefficient; };
  const double valley = height(top) - kLobeDepth;
  std::size_t left = top;
  std::size_t right = top;
  while (left > 0 && height(left) > valley) --left;
  while (right + 1 < curve.size() && height(right) > valley) ++right;
  double highest = -1;
  for (std::size_t i = 1; i + 1 < curve.size(); ++i) {
    const bool outside = i < left || i > right;
    if (outside && height(i) >= height(i - 1) && height(i) >= height(i + 1)) {
      highest = std::max(highest, height(i));
    }
  }
  return highest;
}

/// How clearly the first peak wins: the squared difference of the speeds that is left there,
/// against what is left at the second one. 0: as much; 1: next to nothing.
double distinctness(const TimeOffset& found) {
  const double first_lacks = std::max(1.0 - found.peak, kLeastLack);
  const double second_lacks = std::max(1.0 - found.second_peak, first_lacks);
  return 1.0 - first_lacks / second_lacks;
}

double confidence_of(const TimeOffset& found, const TimeOffsetOptions& options) {
  const double blur = found.sigma_s / (kSharp * options.interval_s);
  return std::clamp(distinctness(found) / (1.0 + blur * blur), 0.0, 1.0);
}

}  // namespace

std::optional<TimeOffset> correlate_angular_speed(const PoseBuffer& hand,
                                                  std::span<const EyeSample> eye,
                                                  const TimeOffsetOptions& options) {
  const std::vector<Interval> intervals = intervals_of(eye, options);
  if (intervals.size() < kMinIntervals || hand.size() < 2) return std::nullopt;

  const double speed_variance = variance_of_speeds(intervals);
  const auto reach = static_cast<int>(std::lround(options.search_s / options.grid_s));
  std::vector<Correlation> curve;
  curve.reserve(2 * static_cast<std::size_t>(reach) + 1);
  std::vector<HandLookup> hand_at_eye(eye.size());
  for (int step = -reach; step <= reach; ++step) {
    curve.push_back(
        correlate_at(hand, eye, intervals, speed_variance, step * options.grid_s, hand_at_eye));
  }

  const auto highest = std::max_element(
      curve.begin(), curve.end(),
      [](const Correlation& a, const Correlation& b) { return a.coefficient < b.coefficient; });
  if (std::min(highest->eye_rms, highest->hand_rms) < options.min_angular_speed_rad_s) {
    return std::nullopt;
  }
  const auto top = static_cast<std::size_t>(highest - curve.begin());
  const std::optional<Peak> peak = refine_peak(curve, top);
  if (!peak || peak->height < options.min_peak) return std::nullopt;

  TimeOffset result;
  result.time_offset_s = (peak->position - reach) * options.grid_s;
  result.peak = std::min(peak->height, 1.0);
  result.second_peak = second_peak(curve, top);
  if (result.second_peak >= options.ambiguity * result.peak) return std::nullopt;

  // Of a signal with known shape in noise: var(offset) = noise / (n * mean square slope); both
  // follow from the peak's height and curvature. Overlapping intervals count once per interval's
  // length.
  double covered_s = 0;
  for (const Interval& interval : intervals) {
    covered_s += seconds_between(eye[interval.from], eye[interval.from + 1]);
  }
  const double independent = std::max(1.0, covered_s / options.interval_s);
  const double slope_per_s2 = -peak->curvature / (options.grid_s * options.grid_s);
  const double noise = 1.0 - result.peak * result.peak;
  result.sigma_s = std::sqrt(noise / (independent * result.peak * slope_per_s2));
  result.confidence = confidence_of(result, options);
  return result;
}

}  // namespace handeye
